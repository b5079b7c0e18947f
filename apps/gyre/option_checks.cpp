// Checks of values on the command line. See option_checks.h.
#include "option_checks.h"

#include "spelling.h"

#include <CLI/CLI.hpp>

#include <map>

namespace gyre {

CLI::Validator number_between(double low, bool open_low, double high, const std::string& expected) {
  return CLI::Validator(
      [=](std::string& text) {
        double value = 0;
        if (CLI::detail::lexical_cast(text, value) && (open_low ? value > low : value >= low) &&
            value <= high) {
          return std::string();
        }
        return "found " + text + ", expected " + expected;
      },
      "", "");
}

namespace {

std::map<const CLI::Option*, std::vector<std::string>>& words_by_option() {
  static std::map<const CLI::Option*, std::vector<std::string>> words;
  return words;
}

}  // namespace

CLI::Option* take_one_of(CLI::Option* option, const std::vector<std::string>& words) {
  words_by_option()[option] = words;
  return option->check(CLI::Validator(
      [words](std::string& text) {
        std::string expected;
        for (const std::string& word : words) {
          if (word == text) return std::string();
          expected += (expected.empty() ? "" : ", ") + word;
        }
        const std::string guess = nearest_word(text, words);
        return "found " + text + ", expected one of " + expected +
               (guess.empty() ? "" : "; did you mean " + guess + "?");
      },
      "", ""));
}

std::vector<std::string> words_of(const CLI::Option* option) {
  const auto found = words_by_option().find(option);
  return found == words_by_option().end() ? std::vector<std::string>() : found->second;
}

CLI::Option* add_threads_option(CLI::App& command, int& threads, const char* help) {
  return command.add_option("--threads", threads, help)
      ->type_name("N")
      ->check(number_between(0, false, kMaxThreads, "an integer from 0 to " + std::to_string(kMaxThreads)));
}

}  // namespace gyre
