# Warnings are errors in every build of talus itself, never in a build that uses talus.
add_library(talus_warnings INTERFACE)
target_compile_options(
  talus_warnings
  INTERFACE $<BUILD_INTERFACE:-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor
            -Woverloaded-virtual>)
# g++ 12 sees overlapping copies in std::string's operator+ that are not there (GCC bug 105651)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(talus_warnings INTERFACE $<BUILD_INTERFACE:-Wno-restrict>)
  # and, under the sanitizers, members of std::regex that are set as if they were not (GCC bug 105562)
  if(CMAKE_CXX_FLAGS MATCHES "-fsanitize")
    target_compile_options(talus_warnings INTERFACE $<BUILD_INTERFACE:-Wno-maybe-uninitialized>)
  endif()
endif()
if(PROJECT_IS_TOP_LEVEL)
  target_compile_options(talus_warnings INTERFACE $<BUILD_INTERFACE:-Werror>)
endif()
