#include "algos/filters/filters.h"

namespace hwsim::algos {

// Each is defined in the file of its name; a new one is a line here and one below.
TechniqueInfo fxaa_filter();
TechniqueInfo axaa_filter();
TechniqueInfo smaa_filter();
TechniqueInfo cmaa_filter();
TechniqueInfo mlaa_filter();
TechniqueInfo tone_map_filter();

Room filter_room() {
  return {.techniques = {fxaa_filter(), axaa_filter(), smaa_filter(), cmaa_filter(), mlaa_filter(),
                         tone_map_filter()}};
}

}  // namespace hwsim::algos
