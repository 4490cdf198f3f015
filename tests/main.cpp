#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <cstring>

// Suites named "long: ..." are for ./test.sh long: here they are left out unless one is asked for.
int main(int argc, char** argv) {
  bool asked = false;
  for (int i = 1; i < argc; ++i) asked |= std::strstr(argv[i], "long:") != nullptr;
  doctest::Context context;
  if (!asked) context.addFilter("test-suite-exclude", "long:*");
  context.applyCommandLine(argc, argv);
  return context.run();
}
