// Values that nobody means end with a plain word before memory is taken, and what is no number with the place of it.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "support/command.h"

namespace test_bounds {

using namespace talus;
using namespace talus::test;

#ifndef __SANITIZE_ADDRESS__  // which reserves more than any limit

TEST_CASE("command: sizes beyond all bounds are refused at once, with little memory") {
  const Folder f;
  const auto told = [&](const std::string& example, const std::string& override, int code,
                        const std::string& part) {
    const Outcome o = shell(
        f,
        fmt::format(
            "ulimit -v 2000000; timeout 10 $talus run {0}/examples/{1}/{1}.toml -q -o out --force --set '{2}'",
            TALUS_SOURCE_DIR, example, override));
    INFO(override, ": ", o.code, " ", o.text);
    CHECK(o.code == code);
    has(o.text, part);
  };
  told("staged_tunnel", "cut.grid=1.7976931348623157e308", 3, "coarser than a model of");
  told("arch", "arch.arch.thickness=1e-9", 3, "has no block left");
  told("bolted_slope", "bolt_type.bar.segment_length=1e-9", 3, "more than 10000 segments");
  told("impact_bar", "grid.bar.move=[1e15, 1]", 3, "no digits left for its shape");
  told("specimen", "tessellation.grains.size=1e300", 3, "nothing would be divided");
  told("spinning_block", "monitor.spinner.block=\"\"", 3, "monitor.spinner.block: is empty");
  told("pile", "output.history_interval=1e-300", 3, "more than 100000 rows of a step");
  told("impact_bar", "monitor.impact.window=1e-300", 5, "in histories.csv");
  told("impact_bar", "model.thickness=1e300", 5, "in steps.csv");
}

#endif

}  // namespace test_bounds
