// The laws as gyre validate runs them: each test with the default parts, then those that are about an exchangeable part
// with every other one.
#include "laws/validation.h"

#include "laws/kit.h"

#include <array>
#include <span>

namespace gyre {

namespace {

using laws::Choice;
using laws::Row;

// Laws that say something about every part of a kind, by suite, whether it holds them or not. The others are about the default
// part, or about joints and machines.
constexpr std::array kOfEveryIntegrator = {
    "Projectile", "LinearDrag", "Damping", "Forces", "Impulses",   "GravityScale", "LockedAxes",  "Incline",
    "Sliding",    "Tower",      "Bounce",  "HeadOn", "MiddleAxis", "Precession",   "FreeRotation"};
constexpr std::array kOfEverySolver = {"Incline",   "Sliding",          "Friction", "Tower",  "Overhang",
                                       "Wedge",     "InclinedStack",    "Bounce",   "HeadOn", "Pendulum",
                                       "BallJoint", "CompoundPendulum", "Overlap"};

bool names(std::span<const char* const> suites, const std::string& suite) {
  return std::any_of(suites.begin(), suites.end(), [&](const char* name) { return suite == name; });
}

// All choices that differ from the default one in one part.
std::vector<Choice> other_choices() {
  std::vector<Choice> choices;
  for (int kind = 0; kind < kIntegratorKindCount; ++kind) {
    if (IntegratorKind(kind) != Choice{}.integrator) choices.push_back({.integrator = IntegratorKind(kind)});
  }
  for (int kind = 0; kind < kSolverKindCount; ++kind) {
    if (SolverKind(kind) != Choice{}.solver) choices.push_back({.solver = SolverKind(kind)});
  }
  return choices;
}

bool is_about(const std::string& law, const Choice& choice) {
  const std::string suite = law.substr(0, law.find('.'));
  return choice.solver == Choice{}.solver ? names(kOfEveryIntegrator, suite) : names(kOfEverySolver, suite);
}

// Takes what tests measured and where they failed.
class Collector : public testing::EmptyTestEventListener {
 public:
  explicit Collector(Progress& progress) : progress_(progress) {}

  void parallel_filter(const Choice& choice) {
    laws::choice() = choice;
    default_parts_ = choice.integrator == Choice{}.integrator && choice.solver == Choice{}.solver;
    integrator_ = to_string(choice.integrator);
    solver_ = to_string(choice.solver);
  }
  void OnTestIterationStart(const testing::UnitTest& all, int) override {
    total_ = int(validation.laws.size()) + all.test_to_run_count();
  }
  void OnTestStart(const testing::TestInfo&) override {
    laws::rows().list.clear();
    laws::in_use() = laws::choice();
    failure_.clear();
  }
  void OnTestPartResult(const testing::TestPartResult& result) override {
    if (result.failed() && failure_.empty()) failure_ = result.summary();
  }
  void OnTestEnd(const testing::TestInfo& info) override {
    const std::string law = std::string(info.test_suite_name()) + "." + info.name();
    for (const Row& row : laws::rows().list) {
      validation.rows.push_back({law, row.name, to_string(row.parts.integrator), to_string(row.parts.solver),
                                 row.measured, row.expected, row.good, row.top, row.is_limit, row.met,
                                 row.met_top});
    }
    validation.laws.push_back({law, integrator_, solver_, default_parts_,
                               double(info.result()->elapsed_time()) * 1.0e-3, failure_});
    progress_.show(std::uint64_t(1000 * validation.laws.size()) / std::uint64_t(std::max(total_, 1)));
  }

  Validation validation;

 private:
  Progress& progress_;
  std::string integrator_, solver_, failure_;
  bool default_parts_ = true;
  int total_ = 0;
};

// What failed, the collector knows.
int run_matching(const std::string& pattern, const Choice& choice, Collector& collector) {
  GTEST_FLAG_SET(filter, pattern);
  collector.parallel_filter(choice);
  return RUN_ALL_TESTS();
}

}  // namespace

Validation run_validation(const ValidateOptions& options, Progress& progress) {
  std::string name = "gyre";
  std::array<char*, 2> arguments = {name.data(), nullptr};
  int count = 1;
  testing::InitGoogleTest(&count, arguments.data());
  testing::UnitTest& all = *testing::UnitTest::GetInstance();
  testing::TestEventListeners& listeners = all.listeners();
  delete listeners.Release(listeners.default_result_printer());
  Collector collector(progress);
  listeners.Append(&collector);
  laws::rows().printed = false;

  run_matching(options.filter + (options.slow ? "" : "-Long*"), {}, collector);
  const std::vector<ValidationLaw> chosen = collector.validation.laws;
  for (const Choice& choice : !options.default_parts ? other_choices() : std::vector<Choice>{}) {
    std::string pattern;
    for (const ValidationLaw& one : chosen) {
      if (is_about(one.law, choice)) pattern += (pattern.empty() ? "" : ":") + one.law;
    }
    if (!pattern.empty()) run_matching(pattern, choice, collector);
  }
  listeners.Release(&collector);
  laws::choice() = {};
  return std::move(collector.validation);
}

}  // namespace gyre
