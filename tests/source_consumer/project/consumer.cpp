// The hardware model alone: a work trace by hand, a GPU, a time.
#include <cstdio>

#include "hwsim/engines/timing.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const hwsim::GpuConfig gpu = hwsim::load_gpu("gtx980", {}, {}, argv[1]);
  hwsim::WorkTrace trace;
  hwsim::PassWork pass;
  pass.name = "shade";
  pass.kind = hwsim::PassKind::full_screen;
  pass.chunks.resize(1);
  pass.chunks[0].stats.fragment_shader_invocations = 1280 * 720;
  pass.chunks[0].raster.fragments = 1280 * 720;
  trace.passes.push_back(pass);
  const hwsim::FrameTiming timing = hwsim::time_frame(trace, gpu, hwsim::Engine::queue);
  std::printf("%.3f ms on %s\n", timing.time_ns / 1e6, gpu.title.c_str());
  return timing.time_ns > 0.0 ? 0 : 1;
}
