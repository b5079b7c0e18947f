// gyre completion and gyre manual: scripts for shells and a manual page. In: the description of the command line itself (CLI::App), so that
// neither can miss an option. Out: text on stdout, which the build stores and CMake installs.
#include "commands.h"
#include "exit_code.h"
#include "option_checks.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace gyre {
namespace {

struct OptionText {
  std::string name;  // with its dashes
  std::string help;
  std::string placeholder;  // of its value; empty: a flag
  std::vector<std::string> words;

  bool takes_file() const { return placeholder.find("FILE") != std::string::npos; }
  bool takes_folder() const { return placeholder.find("FOLDER") != std::string::npos; }
};

std::vector<const CLI::App*> commands_of(const CLI::App& app) { return app.get_subcommands({}); }

std::vector<OptionText> options_of(const CLI::App& command) {
  std::vector<OptionText> out;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional()) continue;
    OptionText text;
    text.name = option->get_name(false, false);
    const std::size_t comma = text.name.find(',');
    if (comma != std::string::npos) text.name = text.name.substr(comma + 1);
    text.help = option->get_description();
    if (option->get_expected_max() > 0) text.placeholder = option->get_type_name();
    text.words = words_of(option);
    out.push_back(text);
  }
  return out;
}

std::vector<const CLI::Option*> arguments_of(const CLI::App& command) {
  std::vector<const CLI::Option*> out;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional()) out.push_back(option);
  }
  return out;
}

std::string joined(const std::vector<std::string>& words, const char* between = " ") {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : between) + word;
  return out;
}

// Each of `special` behind `mark`.
std::string escaped(const std::string& text, const std::string& special, const std::string& mark) {
  std::string out;
  for (const char c : text) {
    if (special.find(c) != std::string::npos) out += mark;
    out += c;
  }
  return out;
}

// Inside single quotes of a shell.
std::string shell_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string bash_script(const CLI::App& app) {
  std::vector<std::string> names;
  std::string values, options;
  for (const CLI::App* command : commands_of(app)) {
    names.push_back(command->get_name());
    std::vector<std::string> words;
    for (const OptionText& option : options_of(*command)) {
      words.push_back(option.name);
      if (option.placeholder.empty()) continue;
      values += "    '" + command->get_name() + " " + option.name + "') COMPREPLY=(";
      if (!option.words.empty())
        values += "$(compgen -W " + shell_quoted(joined(option.words)) + " -- \"$word\")";
      if (option.takes_file()) values += "$(compgen -f -- \"$word\")";
      if (option.takes_folder()) values += "$(compgen -d -- \"$word\")";
      values += "); return ;;\n";
    }
    options += "    " + command->get_name() + ") words=" + shell_quoted(joined(words)) + " ;;\n";
  }
  return "# bash completion of gyre\n_gyre() {\n  local word=\"${COMP_WORDS[COMP_CWORD]}\" "
         "before=\"${COMP_WORDS[COMP_CWORD-1]}\""
         " words=''\n  COMPREPLY=()\n  if [ \"$COMP_CWORD\" -eq 1 ]; then\n    COMPREPLY=($(compgen -W " +
         shell_quoted(joined(names) + " --help --version") +
         " -- \"$word\"))\n    return\n  fi\n  case \"${COMP_WORDS[1]} $before\" in\n" + values +
         "  esac\n  case \"${COMP_WORDS[1]}\" in\n" + options +
         "  esac\n  if [[ \"$word\" == -* ]]; then\n    COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n  "
         "else\n"
         "    COMPREPLY=($(compgen -f -- \"$word\"))\n  fi\n}\ncomplete -o filenames -F _gyre gyre\n";
}

std::string zsh_option(const OptionText& option) {
  std::string text =
      option.name + (option.placeholder.empty() ? "" : "=") + "[" + escaped(option.help, "[]:\\", "\\") + "]";
  if (!option.placeholder.empty()) {
    text += ":" + escaped(option.placeholder, ":\\", "\\") + ":";
    if (!option.words.empty()) text += "(" + joined(option.words) + ")";
    if (option.takes_file()) text += "_files";
    if (option.takes_folder()) text += "_files -/";
  }
  return shell_quoted(text);
}

std::string zsh_script(const CLI::App& app) {
  std::string names, cases;
  for (const CLI::App* command : commands_of(app)) {
    names += "      " +
             shell_quoted(command->get_name() + ":" + escaped(command->get_description(), ":\\", "\\")) +
             "\n";
    cases += "        " + command->get_name() + ") _arguments";
    for (const OptionText& option : options_of(*command)) cases += " \\\n          " + zsh_option(option);
    cases += " \\\n          '*:file:_files' ;;\n";
  }
  return "#compdef gyre\n# zsh completion of gyre\n_gyre() {\n  local state line\n  _arguments -C '1: "
         ":->command' '*:: :->rest'\n"
         "  case $state in\n    command)\n      local -a commands=(\n" +
         names + "      )\n      _describe command commands ;;\n    rest)\n      case $words[1] in\n" +
         cases + "      esac ;;\n  esac\n}\n_gyre \"$@\"\n";
}

std::string fish_script(const CLI::App& app) {
  std::string out =
      "# fish completion of gyre\ncomplete -c gyre -n __fish_use_subcommand -l version -d 'Print the "
      "version'\n";
  for (const CLI::App* command : commands_of(app)) {
    out += "complete -c gyre -f -n __fish_use_subcommand -a " + command->get_name() + " -d " +
           shell_quoted(command->get_description()) + "\n";
    for (const OptionText& option : options_of(*command)) {
      out += "complete -c gyre -n '__fish_seen_subcommand_from " + command->get_name() + "' -l " +
             option.name.substr(2) + " -d " + shell_quoted(option.help);
      if (!option.placeholder.empty()) {
        out += option.takes_file() || option.takes_folder() ? " -r" : " -x";
        if (!option.words.empty()) out += " -a " + shell_quoted(joined(option.words));
      }
      out += "\n";
    }
  }
  return out;
}

// A line of a manual page: dashes and backslashes stand for themselves, and nothing is taken for a request.
std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c == '\n' ? ' ' : c;
    }
  }
  if (!out.empty() && (out[0] == '.' || out[0] == '\'')) out = "\\&" + out;
  return out;
}

std::string manual_section(const CLI::App& command) {
  std::string usage = "gyre " + command.get_name();
  for (const CLI::Option* argument : arguments_of(command)) {
    const std::string name = argument->get_name(true, false);
    usage += argument->get_required() ? " " + name : " [" + name + "]";
  }
  std::string out = ".SS " + roff(usage + " [options]") + "\n" + roff(command.get_description()) + ".\n";
  for (const CLI::Option* argument : arguments_of(command))
    out +=
        ".TP\n.I " + roff(argument->get_name(true, false)) + "\n" + roff(argument->get_description()) + "\n";
  for (const OptionText& option : options_of(command)) {
    out += ".TP\n.B " + roff(option.name);
    if (!option.placeholder.empty()) out += " \\fI" + roff(option.placeholder) + "\\fR";
    out += "\n" + roff(option.help) + "\n";
  }
  return out;
}

std::string manual_page(const CLI::App& app) {
  std::string out = ".TH GYRE 1 \"\" \"gyre " GYRE_VERSION_STRING
                    "\" \"User Commands\"\n.SH NAME\ngyre \\- physics of scenes\n"
                    ".SH SYNOPSIS\n.B gyre\n.I COMMAND\n[options]\n.SH DESCRIPTION\n" +
                    roff(app.get_description()) + "\n.SH COMMANDS\n";
  for (const CLI::App* command : commands_of(app)) out += manual_section(*command);
  return out +
         ".SH EXIT STATUS\n.TP\n0\nThe command did its work.\n.TP\n1\nA law does not hold (validate), or a "
         "replay differs (replay).\n"
         ".TP\n2\nOptions or arguments are wrong.\n.TP\n3\nAn input cannot be read or is invalid, or an "
         "output cannot be written.\n"
         ".TP\n4\nThe simulation stopped being finite.\n.TP\n130\nThe command was interrupted.\n"
         ".SH ENVIRONMENT\n.TP\nGYRE_CACHE\nFolder of kept convex decompositions; ~/.cache/gyre if not set.\n"
         ".TP\nGYRE_VIEWER\nFolder of the built viewer, for gyre view.\n"
         ".SH EXAMPLES\n.nf\ngyre simulate scene.gyre.json \\-\\-duration 5 \\-\\-record run.gyrec\ngyre "
         "replay run.gyrec\n"
         "gyre render run.gyrec \\-\\-out movie.gif\ngyre simulate scene.gyre.json \\-\\-trace \\- | "
         "head\n.fi\n";
}

int print(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
  return kExitGood;
}

}  // namespace

void add_completion(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("completion", "Print a script that completes commands and options in a shell");
  const auto shell = std::make_shared<std::string>();
  take_one_of(command->add_option("SHELL", *shell, "bash, zsh or fish")->required()->type_name(""),
              {"bash", "zsh", "fish"});
  command->callback([shell, &app, &exit_code] {
    exit_code = print(*shell == "bash"  ? bash_script(app)
                      : *shell == "zsh" ? zsh_script(app)
                                        : fish_script(app));
  });
}

void add_manual(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("manual", "Print the manual page (roff); gyre manual | man -l - shows it");
  command->callback([&app, &exit_code] { exit_code = print(manual_page(app)); });
}

}  // namespace gyre
