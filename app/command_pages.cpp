#include "command_pages.h"

#include <fmt/format.h>

#include <vector>

#include "help.h"
#include "talus/base/version.h"

namespace talus::app {

namespace {

std::vector<const CLI::App*> verbs_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

// "--output" and "-o" of an option; nothing of a positional one.
std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> out;
  for (const std::string& name : option.get_snames()) out.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) out.push_back("--" + name);
  return out;
}

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string out;
  for (const std::string& w : words) out += (out.empty() ? "" : between) + w;
  return out;
}

std::vector<std::string> options_of(const CLI::App& verb) {
  std::vector<std::string> out;
  for (const CLI::Option* option : verb.get_options())
    for (const std::string& name : names_of(*option)) out.push_back(name);
  return out;
}

std::string bash_script(const CLI::App& app) {
  std::vector<std::string> verbs;
  std::string cases, values;
  for (const CLI::App* verb : verbs_of(app)) {
    verbs.push_back(verb->get_name());
    for (const CLI::Option* option : verb->get_options()) {
      const std::vector<std::string> choices = choices_of(*option);
      if (choices.empty()) continue;
      std::vector<std::string> names = names_of(*option);
      if (names.empty()) names = {verb->get_name()};  // the word after the verb
      std::string pattern;
      for (const std::string& name : names)
        pattern += (pattern.empty() ? "" : " | ") + fmt::format("\"{} {}\"", verb->get_name(), name);
      values += fmt::format("    {}) choices=\"{}\" ;;\n", pattern, joined(choices, " "));
    }
    cases += fmt::format("    {}) words=\"{}\" ;;\n", verb->get_name(), joined(options_of(*verb), " "));
  }
  return fmt::format(
      "_talus() {{\n"
      "  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} words= choices=\n"
      "  if [ \"$COMP_CWORD\" = 1 ]; then\n"
      "    COMPREPLY=($(compgen -W \"{} {}\" -- \"$word\"))\n"
      "    return\n"
      "  fi\n"
      "  case ${{COMP_WORDS[1]}} in\n{}  esac\n"
      "  case \"${{COMP_WORDS[1]}} $before\" in\n{}  esac\n"
      "  if [ -n \"$choices\" ]; then\n"
      "    COMPREPLY=($(compgen -W \"$choices\" -- \"$word\"))\n"
      "    return\n"
      "  fi\n"
      "  case $word in\n"
      "    -*) COMPREPLY=($(compgen -W \"$words\" -- \"$word\")) ;;\n"
      "    *) COMPREPLY=($(compgen -f -- \"$word\")) ;;\n"
      "  esac\n"
      "}}\n"
      "complete -o filenames -F _talus talus\n",
      joined(verbs, " "), joined(options_of(app), " "), cases, values);
}

// Text in single quotes for fish.
std::string fish_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return out + "'";
}

std::string fish_script(const CLI::App& app) {
  std::string out;
  for (const CLI::App* verb : verbs_of(app)) {
    out += fmt::format("complete -c talus -n __fish_use_subcommand -f -a {} -d {}\n", verb->get_name(),
                       fish_quoted(verb->get_description()));
    for (const CLI::Option* option : verb->get_options()) {
      if (names_of(*option).empty()) continue;
      std::string names;
      for (const std::string& s : option->get_snames()) names += " -s " + s;
      for (const std::string& l : option->get_lnames()) names += " -l " + l;
      const std::vector<std::string> choices = choices_of(*option);
      const std::string values = choices.empty() ? "" : " -x -a " + fish_quoted(joined(choices, " "));
      out += fmt::format("complete -c talus -n '__fish_seen_subcommand_from {}'{}{} -d {}\n",
                         verb->get_name(), names, values, fish_quoted(option->get_description()));
    }
  }
  return out;
}

// Text as roff takes it.
std::string roff(const std::string& text) {
  std::string out;
  for (size_t i = 0; i < text.size(); ++i) {
    const bool starts_line = i == 0 || text[i - 1] == '\n';
    if (starts_line && (text[i] == '.' || text[i] == '\'')) out += "\\&";
    if (text[i] == '\\')
      out += "\\e";
    else if (text[i] == '-')
      out += "\\-";
    else
      out += text[i];
  }
  return out;
}

std::string option_entry(const CLI::Option& option) {
  std::string head;
  const std::vector<std::string> names = names_of(option);
  if (names.empty())
    head = "\\fI" + roff(option.get_name()) + "\\fR";
  else
    head = "\\fB" + roff(joined(names, ", ")) + "\\fR";
  std::string text = option.get_description();
  if (!option.get_default_str().empty()) text += " (default " + option.get_default_str() + ")";
  return ".TP\n" + head + "\n" + roff(text) + "\n";
}

}  // namespace

std::string completion_script(const CLI::App& app, const std::string& shell) {
  if (shell == "fish") return fish_script(app);
  const std::string bash = bash_script(app);
  return shell == "bash" ? bash : "autoload -U +X bashcompinit && bashcompinit\n" + bash;
}

std::string manual_page(const CLI::App& app) {
  std::string out = fmt::format(".TH TALUS 1 \"\" \"talus {}\" \"User commands\"\n", kVersion);
  out += ".SH NAME\ntalus \\- " + roff("blocks that move, slip and break under dynamic load") + "\n";
  out += ".SH SYNOPSIS\n.B talus\n\\fIVERB\\fR [\\fIOPTIONS\\fR]\n";
  out += ".SH DESCRIPTION\n" + roff(app.get_description()) + "\n";
  for (const CLI::App* verb : verbs_of(app)) {
    out += ".SH TALUS " + roff(verb->get_name()) + "\n" + roff(verb->get_description()) + "\n";
    for (const CLI::Option* option : verb->get_options()) out += option_entry(*option);
    if (!verb->get_footer().empty()) out += ".PP\n.nf\n" + roff(verb->get_footer()) + "\n.fi\n";
  }
  return out + ".SH NOTES\n.nf\n" + roff(app.get_footer()) + "\n.fi\n";
}

}  // namespace talus::app
