#pragma once
// The errors that end a run, each with the exit code that the command returns for it.
// What went wrong with numbers during a step is a result, not an exception, until run/ decides to stop.

#include <stdexcept>
#include <string>
#include <vector>

namespace talus {

/// Exit codes of the `talus` command.
enum ExitCode : int {
  kExitOk = 0,
  kExitInternal = 1,     // our own mistake
  kExitUsage = 2,        // wrong command line
  kExitInput = 3,        // the model file
  kExitFile = 4,         // a file or disk
  kExitNumerical = 5,    // no convergence, non-finite numbers, an inverted block
  kExitMechanism = 6,    // a static stage finds no balance: something slides
  kExitResources = 7,    // no memory, or no threads
  kExitNotValid = 8,     // the run ended, and the audit says that its results are not valid
  kExitDiffers = 9,      // two results are further apart than they may be (talus compare)
  kExitUnfinished = 10,  // some runs of a study did not end; the same command makes them again
  kExitSignal = 128      // and the number of the signal that ended it; results up to then are valid
};

class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& text) : std::runtime_error(text), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

/// The model cannot be used. what() holds every finding, ready to print.
class InputError : public Error {
 public:
  explicit InputError(const std::string& text) : Error(kExitInput, text) {}
};

/// A file could not be read or written.
class FileError : public Error {
 public:
  explicit FileError(const std::string& text) : Error(kExitFile, text) {}
};

/// A step could not be taken; the text carries time, step, block and contact ids and what was tried.
class NumericalError : public Error {
 public:
  explicit NumericalError(const std::string& text) : Error(kExitNumerical, text) {}
};

/// Reports a broken invariant of talus itself.
[[noreturn]] void fail_assertion(const char* condition, const char* file, int line);

}  // namespace talus

// Builds without NDEBUG (debug, sanitize) watch what only our own mistakes can break; what users write is
// judged in every build.
#if defined(NDEBUG) && !defined(TALUS_ASSERTIONS)
#define TALUS_ASSERT(condition) static_cast<void>(0)
#define TALUS_VALIDATE(...) static_cast<void>(0)
#else
#define TALUS_ASSERT(condition) \
  ((condition) ? static_cast<void>(0) : ::talus::fail_assertion(#condition, __FILE__, __LINE__))
#define TALUS_VALIDATE(...) ::talus::validate(__VA_ARGS__)
#endif
