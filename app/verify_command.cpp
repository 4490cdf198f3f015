#include "verify_command.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/base/program.h"

namespace talus::app {

namespace fs = std::filesystem;

namespace {

// Where a build and an installation put the cases, from the program.
fs::path cases_program() {
  std::error_code ec;
  const fs::path program = program_folder();
  for (const char* place : {"../tests/verification", "../lib/talus/verification"})
    if (fs::exists(program / place, ec)) return (program / place).lexically_normal();
  throw FileError("the verification cases are not built; ./run.sh --verify builds and runs them");
}

// A word of a shell command.
std::string shell_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  for (size_t begin = 0; begin <= line.size();) {
    const size_t end = std::min(line.find('|', begin), line.size());
    std::string cell = line.substr(begin, end - begin);
    const size_t first = cell.find_first_not_of(' '), last = cell.find_last_not_of(" \n");
    cells.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
    begin = end + 1;
  }
  return cells;
}

// A comparison: residual | what | computed | exact | error | allowed | stretch | reached
using Cells = std::vector<std::string>;

std::FILE* started(const std::string& cases, const std::string& variables) {
  std::string command = variables + shell_quoted(cases_program().string()) + " --no-version --no-colors";
  if (!cases.empty()) command += " " + shell_quoted("--test-case=" + cases);
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (!pipe) throw FileError("the verification cases cannot be started");
  return pipe;
}

// What the cases print: before a comparison its case, where these are put side by side; comparisons; why one is not computed.
template <class Take, class Rest>
int read_lines(std::FILE* pipe, const Take& take, const Rest& rest) {
  std::string text;
  std::array<char, 4096> buffer{};
  while (std::fgets(buffer.data(), count_of(buffer), pipe)) {
    text += buffer.data();
    if (text.back() != '\n') continue;  // a reason may be long
    const bool ours = text.rfind("residual | ", 0) == 0 || text.rfind("not computed | ", 0) == 0 ||
                      text.rfind("pair | ", 0) == 0;
    if (ours)
      take(cells_of(text), text);
    else
      rest(text);
    text.clear();
  }
  return pclose(pipe);
}

// What another formulation made of the cases.
struct Column {
  std::string formulation;
  using Key = std::pair<std::string, std::string>;  // case, what is compared
  std::map<Key, std::deque<Cells>> rows;
  std::map<std::string, std::string> not_computed;  // by case, why
  std::vector<std::string> missing;                 // cases with comparisons that have no number
  int within = 0, missed = 0, none = 0;
};

Column column_of(const std::string& cases, const std::string& formulation) {
  Column c;
  c.formulation = formulation;
  std::string of;
  read_lines(
      started(cases, "TALUS_TEST_PAIRED=1 TALUS_TEST_FORMULATION=" + shell_quoted(formulation) + " "),
      [&](const Cells& cells, const std::string&) {
        if (cells.front() == "pair")
          of = cells[1];
        else if (cells.front() == "residual" && cells.size() > 6)
          c.rows[{of, cells[1]}].push_back(cells);
        else if (cells.front() == "not computed")
          c.not_computed.emplace(cells[1], cells[2]);
      },
      [](const std::string&) {});
  return c;
}

bool is_within(const Cells& c) {
  // a bound from below has no error
  return c[4].empty() ? std::stod(c[2]) >= std::stod(c[5]) : std::stod(c[4]) <= std::stod(c[5]);
}

// The two cells of a column: what it computed, and its error.
std::array<std::string, 2> cells_in(Column& column, const std::string& of, const std::string& what) {
  std::deque<Cells>& found = column.rows[{of, what}];
  if (found.empty()) {
    ++column.none;
    if (column.missing.empty() || column.missing.back() != of) column.missing.push_back(of);
    return {"-", ""};
  }
  const Cells c = found.front();
  found.pop_front();
  const bool within = is_within(c);
  ++(within ? column.within : column.missed);
  return {c[2], (c[4].empty() ? "" : c[4] + " ") + (within ? "within" : "misses")};
}

void print_head(const VerifyArguments& args) {
  const std::string other = args.formulation.empty() ? "" : "by " + args.formulation;
  if (args.markdown) {
    fmt::print("| what | computed | exact | error | allowed |{}\n|---|---|---|---|---|{}\n",
               other.empty() ? "" : fmt::format(" {} | error |", other), other.empty() ? "" : "---|---|");
  } else {
    fmt::print("{:<62} {:>15} {:>15} {:>9} {:>8}", "what", "computed", "exact", "error", "allowed");
    if (!other.empty()) fmt::print(" {:>15} {:>15}", other, "error");
    fmt::print("\n");
  }
}

// @param of  its case; runs: a model; column null: no further cells
void print_row(const Cells& c, bool markdown, const std::string& of, bool runs, Column* column) {
  if (markdown)
    fmt::print("| {} | {} | {} | {} | {}{} |", c[1], c[2], c[3], c[4], c[5],
               c.back() == "known defect" ? ", known defect" : "");
  else
    fmt::print("{:<62} {:>15} {:>15} {:>9} {:>8}", c[1], c[2], c[3], c[4], c[5]);
  if (column) {
    const auto [value, error] = runs ? cells_in(*column, of, c[1]) : std::array<std::string, 2>{};
    if (markdown)
      fmt::print(" {} | {} |", value, error);
    else
      fmt::print(" {:>15} {:>15}", value, error);
  }
  fmt::print("\n");
  std::fflush(stdout);
}

void print_end(const Column& c, bool markdown) {
  fmt::print("\nBy {}: {} comparisons within what is allowed, {} not, {} not computed{}\n", c.formulation,
             c.within, c.missed, c.none, c.missing.empty() ? "" : ":");
  if (markdown && !c.missing.empty()) fmt::print("\n");
  for (const std::string& name : c.missing) {
    const auto why = c.not_computed.find(name);
    const std::string text =
        why == c.not_computed.end() ? "the run does not come to what is compared" : why->second;
    markdown ? fmt::print("- {}: {}\n", name, text) : fmt::print("  {}\n    {}\n", name, text);
  }
}

}  // namespace

void add_verify_arguments(CLI::App& verb, VerifyArguments& args) {
  verb.add_option("CASES", args.cases,
                  "only cases whose name holds this, for example A5; without: all, some minutes");
  verb.add_flag("--markdown", args.markdown, "as a table for a document");
  verb.add_option(
          "--formulation", args.formulation,
          "beside them, in a column of its own, what penalty makes of the cases (A1 to A8) or as_printed (A1 to A3)")
      ->check(CLI::IsMember({"penalty", "as_printed"}));
  verb.footer("Example: talus verify \"bar impact\"");
}

int verify_command(const VerifyArguments& args) {
  std::string cases = args.cases.empty() ? "" : "*" + args.cases + "*";
  std::optional<Column> column;
  if (!args.formulation.empty()) {
    // the others are tests of a part of one formulation; the printed equations are for impact and sliding
    const char last = args.formulation == "as_printed" ? '3' : '8';
    if (cases.empty())
      for (char k = '1'; k <= last; ++k) cases += fmt::format("{}A{}*", cases.empty() ? "" : ",", k);
    column = column_of(cases, args.formulation);
  }
  std::FILE* pipe = started(cases, column ? "TALUS_TEST_PAIRED=1 " : "");
  print_head(args);
  std::string rest, of;
  bool runs = true;  // a model: a comparison without one says nothing of a formulation
  int compared = 0;
  std::set<std::string> seen;
  const int status = read_lines(
      pipe,
      [&](const Cells& cells, const std::string& line) {
        if (cells.front() == "pair") of = cells[1], runs = cells[2] == "model";
        if (cells.front() != "residual" || cells.size() <= 6) return;
        if (!column && !seen.insert(line).second) return;
        print_row(cells, args.markdown, of, runs, column ? &*column : nullptr);
        ++compared;
      },
      [&rest](const std::string& line) { rest += line; });
  const bool passed = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  if (compared == 0 && passed && !args.cases.empty())
    throw Error(kExitUsage,
                fmt::format("no case has \"{}\" in its name, or none that has compares numbers", args.cases));
  if (!passed)
    fmt::print("\n{}\n", rest);  // what failed, in the words of the test program
  else if (!args.markdown)
    fmt::print("\n{} comparisons, every one within what is allowed\n", compared);
  if (column) print_end(*column, args.markdown);
  return passed ? kExitOk : kExitInternal;
}

}  // namespace talus::app
