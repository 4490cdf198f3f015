#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <cstring>

// Suites named "long: ..." are for ./test.sh long: here they are left out unless one is asked for. The suite
// "optimised" is left out of the sanitizer build, ten times slower, where shorter cases run the same code.
int main(int argc, char** argv) {
  bool asked = false;
  for (int i = 1; i < argc; ++i) asked |= std::strstr(argv[i], "long:") != nullptr;
  doctest::Context context;
  if (!asked) context.addFilter("test-suite-exclude", "long:*");
#ifdef __SANITIZE_ADDRESS__
  context.addFilter("test-suite-exclude", "optimised");
#endif
  context.applyCommandLine(argc, argv);
  return context.run();
}
