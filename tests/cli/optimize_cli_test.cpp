// `hwsim optimize` as people use it: the words that it prints make its GPU again.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace hwsim::cli::test {
namespace {

using nlohmann::json;

TEST(Optimize, TheWordsThatItPrintsMakeItsGpuAgain) {
  const Workplace place;
  place.write("triangle.gltf", kTriangleGltf);
  place.write("my nova.toml",
              "schema = 1\nkind = \"gpu\"\nid = \"nova\"\nextends = \"gtx980\"\ncrop_units = 48\n");
  const std::string view =
      " triangle.gltf -t msaa4x --resolution 64x48 --overlay l2-x4 --set gpu.draw_cycles=9 ";
  const std::string asked = "optimize" + view + "-g 'my nova.toml' --prices example --area 300 --front 0";
  const Outcome text = place.hwsim(asked);
  ASSERT_EQ(text.status, 0) << text.err;
  const std::string start = "This GPU: ";
  const std::size_t at = text.out.find(start);
  ASSERT_NE(at, std::string::npos) << text.out;
  const std::string words = text.out.substr(at + start.size(), text.out.find('\n', at) - at - start.size());
  EXPECT_NE(words.find("-g 'my nova.toml' --overlay l2-x4 --set gpu.draw_cycles=9 "), std::string::npos)
      << words;
  const json found = json::parse(place.hwsim(asked + " --json").out);
  const json run = json::parse(
      place.hwsim("run triangle.gltf -t msaa4x --resolution 64x48 --no-image --json " + words).out);
  EXPECT_EQ(run["frame"]["time_ms"], found["best"]["time_ms"]) << words;
  for (const auto& [key, bound] : found["best"]["bounds"].items())
    EXPECT_NE(text.out.find("on its " + bound.get<std::string>() + " bound"), std::string::npos) << key;
}

}  // namespace
}  // namespace hwsim::cli::test
