#include "pipeline/graph/commands.h"

namespace hwsim::pipeline {
namespace {

void record_draws(const FrameGraph& graph, const Pass& pass, std::vector<Command>& out) {
  const Scene& scene = graph.scene();
  std::uint32_t number = 0;
  for (std::uint32_t b = 0; b < pass.batches.size(); ++b) {
    out.push_back({CommandKind::bind_pipeline, b, 0, 1});
    int bound_material = -1;
    for (const DrawCall& call : pass.batches[b].draws) {
      const Instance& instance = scene.instances[static_cast<std::size_t>(call.instance)];
      const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
      const Mesh::Part& part = mesh.parts[static_cast<std::size_t>(call.part)];
      if (part.material != bound_material) out.push_back({CommandKind::bind_resources, b, number, 1});
      bound_material = part.material;
      out.push_back(
          {CommandKind::draw, b, number++, call.list ? call.list->indices.size() : part.index_count});
    }
  }
}

}  // namespace

std::string_view command_name(CommandKind kind) {
  switch (kind) {
    case CommandKind::barrier:
      return "barrier";
    case CommandKind::bind_targets:
      return "bind_targets";
    case CommandKind::bind_pipeline:
      return "bind_pipeline";
    case CommandKind::bind_resources:
      return "bind_resources";
    case CommandKind::draw:
      return "draw";
    case CommandKind::dispatch:
      return "dispatch";
    case CommandKind::clear:
      return "clear";
    case CommandKind::copy:
      return "copy";
    case CommandKind::resolve:
      return "resolve";
  }
  return "draw";
}

std::uint32_t command_words(CommandKind kind) {
  switch (kind) {
    case CommandKind::barrier:
      return 6;
    case CommandKind::bind_targets:
      return 40;
    case CommandKind::bind_pipeline:
      return 64;
    case CommandKind::bind_resources:
      return 24;
    case CommandKind::draw:
      return 6;
    case CommandKind::dispatch:
      return 5;
    case CommandKind::clear:
      return 12;
    case CommandKind::copy:
      return 16;
    case CommandKind::resolve:
      return 16;
  }
  return 0;
}

std::vector<Command> record_pass(const FrameGraph& graph, const Pass& pass, bool barrier_before) {
  std::vector<Command> out;
  out.reserve(8);  // what passes other than draws need
  if (barrier_before) out.push_back({CommandKind::barrier, 0, 0, 1});
  const auto attachments = pass.color.size() + (pass.depth ? 1u : 0u);
  switch (pass.kind) {
    case PassKind::draw:
      out.push_back({CommandKind::bind_targets, 0, 0, attachments});
      record_draws(graph, pass, out);
      break;
    case PassKind::full_screen:
      out.push_back({CommandKind::bind_targets, 0, 0, attachments});
      out.push_back({CommandKind::bind_pipeline, 0, 0, 1});
      out.push_back({CommandKind::bind_resources, 0, 0, pass.sampled.size() + pass.storage.size()});
      out.push_back({CommandKind::draw, 0, 0, 3});  // one triangle that covers the screen
      break;
    case PassKind::compute:
      out.push_back({CommandKind::bind_pipeline, 0, 0, 1});
      out.push_back({CommandKind::bind_resources, 0, 0,
                     pass.sampled.size() + pass.storage.size() + pass.targets.size()});
      out.push_back({CommandKind::dispatch, 0, 0,
                     static_cast<std::uint64_t>(pass.groups_x) * static_cast<std::uint64_t>(pass.groups_y)});
      break;
    case PassKind::clear:
      for (std::size_t i = 0; i < pass.targets.size(); ++i) out.push_back({CommandKind::clear, 0, 0, 1});
      break;
    case PassKind::copy:
      out.push_back({CommandKind::copy, 0, 0, 1});
      break;
    case PassKind::resolve:
      out.push_back({CommandKind::resolve, 0, 0, 1});
      break;
  }
  return out;
}

}  // namespace hwsim::pipeline
