// gyre validate: laws chosen by name, as a table, JSON and a page.
#include "run_program.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace gyre::validate_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class Validate : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("gyre_validate_" + std::to_string(getpid()) + "_" +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_;
};

TEST_F(Validate, PrintsMeasuredAgainstExact) {
  const Finished run =
      run_program({"validate", "--filter", "FreeFall*:Sliding*", "--default-parts"}, folder_);
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find("measured"), std::string::npos);
  EXPECT_NE(run.out.find("A-01"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("with the default parts 0 do not hold"), std::string::npos) << run.out;
  EXPECT_EQ(run.out.find("[row]"), std::string::npos) << "the tests printed beside the table";
}

TEST_F(Validate, ARowNamesThePartsThatItsLawChose) {
  const Finished run = run_program(
      {"validate", "--filter", "Integrators.HaveTheirOrders", "--default-parts", "--json"}, folder_);
  EXPECT_EQ(run.code, 0) << run.err;
  const json table = json::parse(run.out);
  int others = 0;
  for (const json& row : table.at("rows")) {
    const std::string name = row.at("row").get<std::string>(),
                      integrator = row.at("integrator").get<std::string>();
    EXPECT_TRUE(name.ends_with(integrator)) << row;
    if (integrator != "semi_implicit_euler") ++others;
  }
  EXPECT_GT(others, 0);
}

TEST_F(Validate, EveryPartIsNamedInItsRows) {
  const Finished run = run_program({"validate", "--filter", "Projectile.*:Incline.*", "--json"}, folder_);
  EXPECT_EQ(run.code, 0) << run.err;
  const json table = json::parse(run.out);
  std::vector<std::string> parts;
  for (const json& row : table.at("rows")) {
    EXPECT_TRUE(row.at("measured").is_number()) << row;
    EXPECT_GT(row.at("tolerance").get<double>(), 0.0) << row;
    parts.push_back(row.at("integrator").get<std::string>() + " " + row.at("solver").get<std::string>());
  }
  for (const char* wanted : {"semi_implicit_euler soft_step", "rk4 soft_step", "semi_implicit_euler lcp"}) {
    EXPECT_NE(std::find(parts.begin(), parts.end(), wanted), parts.end()) << wanted;
  }
  for (const json& law : table.at("laws")) EXPECT_TRUE(law.at("holds").get<bool>()) << law;
}

TEST_F(Validate, WritesAPage) {
  const Finished run =
      run_program({"validate", "--filter", "FreeFall*", "--default-parts", "--html", "laws.html"}, folder_);
  EXPECT_EQ(run.code, 0) << run.err;
  const std::string page = file_text(folder_ / "laws.html");
  EXPECT_EQ(page.rfind("<!doctype html>", 0), 0u);
  EXPECT_NE(page.find("FreeFall"), std::string::npos);
  EXPECT_NE(page.find("</html>"), std::string::npos);
}

TEST_F(Validate, ALawThatIsNotThereIsWrongUsage) {
  const Finished run = run_program({"validate", "--filter", "NoSuchLaw"}, folder_);
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.err.find("NoSuchLaw"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace gyre::validate_test
