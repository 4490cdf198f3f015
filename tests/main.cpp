#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <cstdio>
#include <cstring>

namespace {

unsigned chosen = 0;  // cases that the filters have let through

// Counts them, for a name that stands for no case: its test would pass for ever.
struct Chosen : doctest::IReporter {
  explicit Chosen(const doctest::ContextOptions&) {}
  void report_query(const doctest::QueryData&) override {}
  void test_run_start() override {}
  void test_run_end(const doctest::TestRunStats& stats) override {
    chosen = stats.numTestCasesPassingFilters;
  }
  void test_case_start(const doctest::TestCaseData&) override {}
  void test_case_reenter(const doctest::TestCaseData&) override {}
  void test_case_end(const doctest::CurrentTestCaseStats&) override {}
  void test_case_exception(const doctest::TestCaseException&) override {}
  void subcase_start(const doctest::SubcaseSignature&) override {}
  void subcase_end() override {}
  void log_assert(const doctest::AssertData&) override {}
  void log_message(const doctest::MessageData&) override {}
  void test_case_skipped(const doctest::TestCaseData&) override {}
};

}  // namespace

REGISTER_LISTENER("chosen", 1, Chosen);

// Suites that are left out unless asked for by name: "long: ...", for ./test.sh long, and, of the sanitizer
// build, ten times slower, "optimised", where shorter cases run the same code.
int main(int argc, char** argv) {
  doctest::Context context;
  const auto leave_out = [&](const char* name, const char* suites) {
    for (int i = 1; i < argc; ++i)
      if (std::strstr(argv[i], name)) return;
    context.addFilter("test-suite-exclude", suites);
  };
  leave_out("long:", "long:*");
#ifdef __SANITIZE_ADDRESS__
  leave_out("optimised", "optimised");
#endif
  context.applyCommandLine(argc, argv);
  const int result = context.run();
  if (context.shouldExit()) return result;  // it has listed them
  for (int i = 1; i < argc && chosen == 0; ++i)
    if (std::strncmp(argv[i], "--test-case=", 12) == 0 && !std::strchr(argv[i], '*')) {  // a whole name
      std::fprintf(stderr, "no case is called like %s\n", argv[i] + 12);
      return 1;
    }
  return result;
}
