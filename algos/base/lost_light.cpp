#include "algos/base/lost_light.h"

#include <string>

namespace hwsim::algos {
namespace {
using pipeline::SpecialSurface;

class Losses {
 public:
  Losses(const std::vector<SpecialSurface>& surfaces, bool holds_blended, std::string_view remedy)
      : surfaces_(surfaces), holds_blended_(holds_blended), remedy_(remedy) {}

  void add(bool SpecialSurface::*trait, const MessageCode& code, const std::string& what) {
    std::size_t count = 0;
    std::string first;
    for (const SpecialSurface& surface : surfaces_) {
      if (!(surface.*trait) || (surface.blended && !holds_blended_)) continue;
      if (count++ == 0) first = surface.material;
    }
    if (count == 0) return;
    Diagnostic note;
    note.severity = Severity::note;
    note.code = code.code;
    note.message = "material `" + first + "`" +
                   (count == 1 ? "" : " and " + std::to_string(count - 1) + " more") + ": " + what;
    note.help = remedy_;
    notes_.push_back(std::move(note));
  }
  std::vector<Diagnostic> take() { return std::move(notes_); }

 private:
  const std::vector<SpecialSurface>& surfaces_;
  bool holds_blended_;
  std::string_view remedy_;
  std::vector<Diagnostic> notes_;
};

}  // namespace

std::vector<Diagnostic> lost_light(const std::vector<SpecialSurface>& surfaces, const SurfaceRecord& record,
                                   std::string_view remedy) {
  Losses losses(surfaces, record.holds_blended, remedy);
  if (record.emission == StoredEmission::none)
    losses.add(&SpecialSurface::emissive, kEmissionIsLost, "emission is not shown, for it is not stored");
  if (record.emission == StoredEmission::luminance)
    losses.add(&SpecialSurface::colored_emission, kEmissionIsGray,
               "colored emission is shown in gray, for its luminance alone is stored");
  if (!record.unlit_mark)
    losses.add(&SpecialSurface::unlit, kUnlitIsEmission,
               "unlit surfaces are shown in gray, for they are stored as emission");
  if (!record.occlusion)
    losses.add(&SpecialSurface::occluded, kOcclusionIsLost,
               "ambient light is not kept off where the occlusion texture says so");
  return losses.take();
}

}  // namespace hwsim::algos
