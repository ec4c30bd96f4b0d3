// What the README shows to users of the library: techniques ranked on a glTF file, under a budget. It tests
// its installation first: the library finds its image module.
#include <hwsim.h>

#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const hwsim::lab::Request request{.view = {.scene = argv[1], .resolution = {64, 48}},
                                    .techniques = {"msaa4x", "fxaa"}};
  hwsim::lab::Lab lab(hwsim::lab::options_of_environment());
  for (const hwsim::lab::SelfCheck& check : lab.check_itself())
    if (!check.ok) {
      std::printf("%s: %s\n", check.name.c_str(), check.detail.c_str());
      return 1;
    }
  const hwsim::lab::Ranking ranking = lab.rank(request, "aa_ms<=1");
  for (const auto& t : ranking.techniques)
    std::printf("%s: %.3f ms, FLIP %.4f, %s\n", t.technique.c_str(), t.frame_ms, t.flip_mean,
                t.verdict.c_str());
  return ranking.techniques.size() == 3 ? 0 : 1;
}
