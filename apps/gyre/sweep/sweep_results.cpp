// Results of a study on disk. See sweep_results.h.
#include "sweep/sweep_results.h"

#include "output_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace gyre {
namespace {

std::string csv_cell(const Json& value) {
  if (value.is_null()) return "";
  std::string text = value.is_string() ? value.get<std::string>() : value.dump();
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

}  // namespace

SweepResults::~SweepResults() {
  if (file_ != nullptr) std::fclose(file_);
}

bool SweepResults::open(const std::string& path, const Study& study) {
  path_ = path;
  std::ifstream in(path, std::ios::binary);
  std::string line;
  std::string kept;
  while (std::getline(in, line)) {
    // The last line of an interrupted run may be cut.
    const Json value = Json::parse(line, nullptr, false);
    if (value.is_discarded() || !value.is_object() || !value.contains("case") ||
        !value["case"].is_number_unsigned())
      continue;
    if (value.value("study", std::string()) != study.fingerprint) {
      message_ = path +
                 ": has results of another study, or of one that was changed since; move it away or name "
                 "another with --output";
      return false;
    }
    lines_[value["case"].get<std::uint64_t>()] = line;
  }
  in.close();
  for (const auto& [number, text] : lines_) kept += text + "\n";
  if (!kept.empty() && !put(path, kept)) return false;
  file_ = std::fopen(path.c_str(), "ab");
  if (file_ != nullptr) return true;
  message_ = path + ": cannot be written: " + std::strerror(errno);
  return false;
}

std::size_t SweepResults::failed() const {
  std::size_t count = 0;
  for (const auto& [number, line] : lines_) count += Json::parse(line).contains("error");
  return count;
}

bool SweepResults::add(std::uint64_t number, const std::string& line) {
  lines_[number] = line;
  const std::string whole = line + "\n";
  if (std::fwrite(whole.data(), 1, whole.size(), file_) == whole.size() && std::fflush(file_) == 0)
    return true;
  message_ = path_ + ": cannot be written: " + std::strerror(errno);
  return false;
}

bool SweepResults::put(const std::string& path, const std::string& text) {
  OutputFile file;
  if (file.open(path) && file.write(text) && file.commit()) return true;
  message_ = file.message();
  return false;
}

bool SweepResults::finish(const Study& study) {
  std::fclose(file_);
  file_ = nullptr;
  std::string text;
  for (const auto& [number, line] : lines_) text += line + "\n";
  const std::filesystem::path path(path_);
  const std::string stem =
      path.extension() == ".jsonl" ? std::filesystem::path(path).replace_extension().string() : path_;
  return put(path_, text) && put(stem + ".csv", results_table(study, lines_)) &&
         put(stem + ".svg", results_chart(study, lines_));
}

std::string results_table(const Study& study, const std::map<std::uint64_t, std::string>& lines) {
  std::string out = "case";
  for (const StudyParameter& parameter : study.parameters) out += "," + csv_cell(parameter.name);
  for (const StudyReading& reading : study.readings) out += "," + csv_cell(reading.name);
  out += ",hash,error\n";
  for (const auto& [number, line] : lines) {
    const Json value = Json::parse(line);
    const auto cell = [&](const char* part, const std::string& name) {
      const auto it = value.find(part);
      out += "," + (it != value.end() && it->contains(name) ? csv_cell((*it)[name]) : std::string());
    };
    out += std::to_string(number);
    for (const StudyParameter& parameter : study.parameters) cell("parameters", parameter.name);
    for (const StudyReading& reading : study.readings) cell("readings", reading.name);
    out += "," + csv_cell(value.value("hash", Json())) + "," + csv_cell(value.value("error", Json())) + "\n";
  }
  return out;
}

}  // namespace gyre
