// The results of a study on disk: JSON lines while cases end, then the same in order of their numbers, a table and a chart.
#pragma once

#include "sweep/study.h"

#include <cstdio>
#include <map>
#include <string>

namespace gyre {

class SweepResults {
 public:
  SweepResults() = default;
  ~SweepResults();
  SweepResults(const SweepResults&) = delete;
  SweepResults& operator=(const SweepResults&) = delete;

  // Reads the lines of an earlier run of the same study and goes on behind them. False, and a message, if the file cannot be used.
  bool open(const std::string& path, const Study& study);
  bool has(std::uint64_t number) const { return lines_.contains(number); }
  std::size_t size() const { return lines_.size(); }
  std::size_t failed() const;
  // Appends a line and flushes it, so that an interrupted run keeps it.
  bool add(std::uint64_t number, const std::string& line);
  // Writes the lines in order of their numbers, and beside them PATH.csv and PATH.svg (without the .jsonl of PATH).
  bool finish(const Study& study);
  const std::string& message() const { return message_; }

 private:
  bool put(const std::string& path, const std::string& text);

  std::string path_, message_;
  std::map<std::uint64_t, std::string> lines_;
  std::FILE* file_ = nullptr;
};

// One row a case: case, parameters, readings, hash, error.
std::string results_table(const Study& study, const std::map<std::uint64_t, std::string>& lines);
// A chart (SVG) with a panel for each reading over each parameter that is a number: a dot a case.
std::string results_chart(const Study& study, const std::map<std::uint64_t, std::string>& lines);

}  // namespace gyre
