// The rooms of techniques. A room lists its own techniques beside their code; a new room is one line here.
#include "algos/agaa/agaa.h"
#include "algos/deferred/deferred.h"
#include "algos/filters/filters.h"
#include "algos/forward/forward.h"
#include "algos/rooms.h"
#include "algos/sbaa/sbaa.h"
#include "algos/sss/sss.h"
#include "algos/wire/wire_aa.h"

namespace hwsim::algos {

std::span<const Room> rooms() {
  static const std::vector<Room> all = {
      forward_room(),   //
      deferred_room(),  //
      sbaa_room(),      //
      agaa_room(),      //
      sss_room(),       //
      wire_room(),      //
      filter_room(),    //
  };
  return all;
}

}  // namespace hwsim::algos
