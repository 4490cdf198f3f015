#include "verify_command.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <set>
#include <vector>

#include "talus/base/error.h"
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

// residual | what | computed | exact | error | pass | stretch | reached
void print_row(const std::vector<std::string>& c, bool markdown) {
  if (markdown)
    fmt::print("| {} | {} | {} | {} | {}{} |\n", c[1], c[2], c[3], c[4], c[5],
               c.back() == "known defect" ? ", known defect" : "");
  else
    fmt::print("{:<62} {:>15} {:>15} {:>9} {:>8}\n", c[1], c[2], c[3], c[4], c[5]);
  std::fflush(stdout);
}

}  // namespace

void add_verify_arguments(CLI::App& verb, VerifyArguments& args) {
  verb.add_option("CASES", args.cases,
                  "only cases whose name holds this, for example A5; without: all, some minutes");
  verb.add_flag("--markdown", args.markdown, "as a table for a document");
  verb.footer("Example: talus verify \"bar impact\"");
}

int verify_command(const VerifyArguments& args) {
  std::string command = shell_quoted(cases_program().string()) + " --no-version --no-colors";
  if (!args.cases.empty()) command += " " + shell_quoted("--test-case=*" + args.cases + "*");
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (!pipe) throw FileError("the verification cases cannot be started");
  if (args.markdown)
    fmt::print("| what | computed | exact | error | allowed |\n|---|---|---|---|---|\n");
  else
    fmt::print("{:<62} {:>15} {:>15} {:>9} {:>8}\n", "what", "computed", "exact", "error", "allowed");
  std::set<std::string> seen;
  std::string rest, line;
  std::array<char, 4096> buffer{};
  while (std::fgets(buffer.data(), static_cast<int>(buffer.size()), pipe)) {
    line = buffer.data();
    if (line.rfind("residual | ", 0) != 0) {
      rest += line;
    } else if (seen.insert(line).second) {
      const std::vector<std::string> cells = cells_of(line);
      if (cells.size() > 6) print_row(cells, args.markdown);
    }
  }
  const int status = pclose(pipe);
  const bool passed = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  if (seen.empty() && passed && !args.cases.empty())
    throw Error(kExitUsage,
                fmt::format("no case has \"{}\" in its name, or none that has compares numbers", args.cases));
  if (!passed)
    fmt::print("\n{}\n", rest);  // what failed, in the words of the test program
  else if (!args.markdown)
    fmt::print("\n{} comparisons, every one within what is allowed\n", seen.size());
  return passed ? kExitOk : kExitInternal;
}

}  // namespace talus::app
