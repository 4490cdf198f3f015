#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <cstring>

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
  return context.run();
}
