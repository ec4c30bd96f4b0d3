#include "hwsim/trace/work_trace.h"

namespace hwsim {

std::string_view pass_kind_name(PassKind kind) {
  switch (kind) {
    case PassKind::draw:
      return "draw";
    case PassKind::full_screen:
      return "full_screen";
    case PassKind::compute:
      return "compute";
    case PassKind::clear:
      return "clear";
    case PassKind::copy:
      return "copy";
    case PassKind::resolve:
      return "resolve";
  }
  return "draw";
}

PassCounters total(const PassWork& pass) {
  PassCounters sum;
  for (const PassCounters& chunk : pass.chunks) sum += chunk;
  return sum;
}

PassCounters total(const WorkTrace& trace) {
  PassCounters sum;
  for (const PassWork& pass : trace.passes) sum += total(pass);
  return sum;
}

}  // namespace hwsim
