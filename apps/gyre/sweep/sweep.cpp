// gyre sweep. See sweep.h.
#include "sweep/sweep.h"

#include "exit_code.h"
#include "interrupt.h"
#include "progress.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <mutex>
#include <thread>
#include <vector>

namespace gyre {
namespace {

void say(const std::string& message) { std::fprintf(stderr, "gyre: %s\n", message.c_str()); }

std::string output_of(const SweepOptions& options) {
  if (!options.output.empty()) return options.output;
  const std::filesystem::path path(options.study);
  return (path.parent_path() / (path.stem().string() + ".results.jsonl")).string();
}

int print_case(const Study& study, std::uint64_t number) {
  if (number >= study.case_count()) {
    say("found case " + std::to_string(number) + ", expected 0 to " + std::to_string(study.case_count() - 1));
    return kExitUsage;
  }
  const std::string line = run_case(study, number);
  std::printf("%s\n", line.c_str());
  return Json::parse(line).contains("error") ? kExitFailed : kExitGood;
}

// Cases that have no line in the results yet, in order.
class OpenCases : public CaseQueue {
 public:
  OpenCases(std::uint64_t cases, SweepResults& results, Progress& progress)
      : cases_(cases), before_(results.size()), results_(results), progress_(progress) {}

  std::optional<std::uint64_t> next() override {
    const std::lock_guard guard(lock_);
    while (next_ < cases_ && results_.has(next_)) ++next_;
    if (next_ >= cases_ || interrupted() || !written_) return std::nullopt;
    return next_++;
  }
  void done(std::uint64_t number, const std::string& line) override {
    const std::lock_guard guard(lock_);
    written_ = results_.add(number, line) && written_;
    progress_.show(results_.size() - before_);
  }
  bool written() const { return written_; }

 private:
  const std::uint64_t cases_, before_;
  SweepResults& results_;
  Progress& progress_;
  std::mutex lock_;
  std::uint64_t next_ = 0;
  bool written_ = true;
};

}  // namespace

void ThreadedCases::run(const Study& study, CaseQueue& queue) {
  const int count = threads_ > 0 ? threads_ : std::max(1, int(std::thread::hardware_concurrency()));
  const auto work = [&] {
    while (const std::optional<std::uint64_t> number = queue.next())
      queue.done(*number, run_case(study, *number));
  };
  std::vector<std::thread> helpers;
  for (int i = 1; i < count; ++i) helpers.emplace_back(work);
  work();
  for (std::thread& helper : helpers) helper.join();
}

int sweep(const SweepOptions& options, CaseRunner& runner) {
  const SceneResult<Study> study = load_study(options.study);
  if (!study) {
    say(study.error().text());
    return kExitInvalid;
  }
  const std::uint64_t cases = study->case_count();
  if (options.count) {
    std::printf("%llu\n", static_cast<unsigned long long>(cases));
    return kExitGood;
  }
  if (options.only) return print_case(*study, *options.only);
  SweepResults results;
  if (!results.open(output_of(options), *study)) {
    say(results.message());
    return kExitInvalid;
  }
  watch_interrupt();
  const std::uint64_t before = results.size();
  Progress progress(!options.quiet, cases - before, "cases");
  OpenCases queue(cases, results, progress);
  runner.run(*study, queue);
  progress.clear();
  const bool whole = results.size() == cases;
  if (!queue.written() || (whole && !results.finish(*study))) {
    say(results.message());
    return kExitInvalid;
  }
  if (!whole) {
    say("interrupted with " + std::to_string(results.size()) + " of " + std::to_string(cases) +
        " cases done; the same command goes on");
    return kExitInterrupted;
  }
  const std::size_t failed = results.failed();
  if (!options.quiet) std::printf("%llu cases, %zu failed\n", static_cast<unsigned long long>(cases), failed);
  return failed > 0 ? kExitFailed : kExitGood;
}

}  // namespace gyre
