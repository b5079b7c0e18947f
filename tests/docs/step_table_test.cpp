// docs/step.md shows the stages of a step as a table; this holds it to the list that the engine runs.
#include "world/stages.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

namespace gyre::step_table_test {
namespace {

std::string source_path(const std::string& path) { return std::string(GYRE_SOURCE_DIR) + "/" + path; }

// The words in backticks in the column `column` (from 0) of the rows that begin with a number.
std::vector<std::string> numbered_cells(const std::string& path, int column) {
  std::ifstream file(source_path(path));
  std::vector<std::string> cells;
  for (std::string line; std::getline(file, line);) {
    if (line.size() < 3 || line[0] != '|' || line[2] < '0' || line[2] > '9') continue;
    std::size_t begin = 1;
    for (int i = 0; i < column; ++i) begin = line.find('|', begin) + 1;
    cells.push_back(line.substr(begin, line.find('|', begin) - begin));
  }
  return cells;
}

std::vector<std::string> words_in_backticks(const std::string& cell) {
  std::vector<std::string> words;
  for (std::size_t at = cell.find('`'); at != std::string::npos; at = cell.find('`', at)) {
    const std::size_t end = cell.find('`', at + 1);
    if (end == std::string::npos) break;
    words.push_back(cell.substr(at + 1, end - at - 1));
    at = end + 1;
  }
  return words;
}

TEST(StepTable, NamesTheStagesInTheOrderOfTheStep) {
  const std::vector<std::string> cells = numbered_cells("docs/step.md", 1);
  ASSERT_EQ(cells.size(), std::size_t(kStageCount));
  for (int i = 0; i < kStageCount; ++i) {
    const std::vector<std::string> names = words_in_backticks(cells[std::size_t(i)]);
    ASSERT_EQ(names.size(), 1u) << cells[std::size_t(i)];
    EXPECT_EQ(names[0], kStageNames[i]);
  }
}

TEST(StepTable, NamesUnitsThatExist) {
  for (const std::string& cell : numbered_cells("docs/step.md", 2)) {
    for (const std::string& unit : words_in_backticks(cell)) {
      EXPECT_TRUE(std::filesystem::exists(source_path("src/" + unit + ".cpp"))) << unit;
    }
  }
}

std::string text_of(const std::string& path) {
  std::ifstream file(source_path(path));
  return std::string((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
}

// The stages of the lines that `p.kind<stage>()` adds in the order of a sub-step; those that are members of other structs left out.
std::vector<std::string> stages_of_program() {
  const std::string text = text_of("src/dynamics/substep_program.cpp");
  const std::regex line("\\bp\\.\\w+<(\\w+)>\\(\\)");
  std::vector<std::string> stages;
  for (std::sregex_iterator found(text.begin(), text.end(), line), end; found != end; ++found)
    stages.push_back((*found)[1]);
  return stages;
}

TEST(StepTable, NamesEveryStageOfASubStep) {
  const std::vector<std::string> stages = stages_of_program();
  EXPECT_GT(stages.size(), 40u);
  const std::string document = text_of("docs/step.md");
  for (const std::string& stage : stages)
    EXPECT_NE(document.find("`" + stage + "`"), std::string::npos) << stage << " is not in docs/step.md";
}

}  // namespace
}  // namespace gyre::step_table_test
