// Checks of values on the command line that several commands share. In: the text of a value. Out: an empty text, or the sentence that says
// what was found and what is expected.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
class Validator;
}  // namespace CLI

namespace gyre {

constexpr int kMaxThreads = 64;  // of the engine: WorldDef::threads

CLI::Validator number_between(double low, bool open_low, double high, const std::string& expected);
// Only words of the list; of a misspelt word the message guesses the nearest. Completion in shells offers these words.
CLI::Option* take_one_of(CLI::Option* option, const std::vector<std::string>& words);
// The words of such an option; empty for all others.
std::vector<std::string> words_of(const CLI::Option* option);

// --threads, with the same range in every command.
CLI::Option* add_threads_option(CLI::App& command, int& threads, const char* help);

}  // namespace gyre
