#include "hwsim/units/shader_cores.h"

namespace hwsim {

IssuedOps issued_ops(const ShaderCounters& s, int subgroup_size) {
  const auto pair = [](std::uint64_t alu, std::uint64_t sfu) {
    return IssuedOps{static_cast<double>(alu), static_cast<double>(sfu)};
  };
  if (subgroup_size <= 8) return pair(s.alu_issued_lane_ops_w8, s.sfu_issued_lane_ops_w8);
  if (subgroup_size <= 16) return pair(s.alu_issued_lane_ops_w16, s.sfu_issued_lane_ops_w16);
  if (subgroup_size <= 32) return pair(s.alu_issued_lane_ops_w32, s.sfu_issued_lane_ops_w32);
  return pair(s.alu_issued_lane_ops_w64, s.sfu_issued_lane_ops_w64);
}

double subgroups_of(const PassCounters& c, int subgroup_size) {
  return static_cast<double>(c.stats.fragment_shader_invocations + c.stats.geometry_shader_invocations +
                             c.stats.compute_shader_invocations) /
         subgroup_size;
}

}  // namespace hwsim
