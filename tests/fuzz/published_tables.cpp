// Published tables and their mapping: the input's pieces, between NULs, are a table and up to five mapping
// files.
#include <array>

#include "cost_models/published.h"
#include "fuzz/fuzz_input.h"

namespace {

struct MappingFile {
  const char* name;
  const char* text;  ///< where the input has none
};
constexpr std::array<MappingFile, 5> kMapping = {
    {{"mapping/uses.csv",
      "document,table,gpu,scene,technique,msaa,surfaces,pass,quantity,use,reason\n*,*,*,*,*,*,*,*,*,fitted,"
      "\n"},
     {"mapping/gpus.csv", "printed,gpu\nGeForce GTX 470,gtx470\n"},
     {"mapping/scenes.csv",
      "document,scene,view,lighting,stand_in,camera,settings,unlit\n*,*,*,*,car_body,0,scene.shadows=false,"
      "\n"},
     {"mapping/techniques.csv",
      "document,technique,gpu,msaa,template,repeat\n*,*,*,*,\"sbaa_top:n={surfaces},msaa={msaa}\",1\n"},
     {"mapping/passes.csv", "document,technique,pass,trace_passes\n*,*,*,*\n"}}};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace hwsim;
  static fuzz::ScratchFolder folder;
  static const bool made = std::filesystem::create_directory(folder.file("mapping"));
  fuzz::require(made, "the scratch folder can be written");
  const std::vector<fuzz::Bytes> pieces = fuzz::pieces(fuzz::Bytes(data, size), 0);
  folder.write("table.csv", pieces.front());
  for (std::size_t i = 0; i < kMapping.size(); ++i) {
    const bool given = i + 1 < pieces.size() && !pieces[i + 1].empty();
    folder.write(kMapping[i].name, given ? fuzz::text_of(pieces[i + 1]) : kMapping[i].text);
  }
  fuzz::answer_or_refuse([&] {
    const std::vector<cost_models::PublishedRow> rows = cost_models::load_published(folder.path());
    for (const cost_models::Cell& cell : cost_models::map_rows(rows, folder.path())) {
      cost_models::pass_matches(cell.passes, "forward");
      if (!cell.run.unlit.empty()) cost_models::without_lights(cell.run);
    }
  });
  return 0;
}
