#include "pipeline/gltf/accessor.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "pipeline/gltf/ranges.h"

namespace hwsim::pipeline::gltf {
namespace {

struct Elements {
  const std::uint8_t* first = nullptr;  ///< null: all zeros
  std::size_t stride = 0;
};

Elements elements_at(const tinygltf::Model& model, int view_index, std::size_t offset,
                     std::size_t element_bytes) {
  if (view_index < 0) return {};
  const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(view_index)];
  const auto& data = model.buffers[static_cast<std::size_t>(view.buffer)].data;
  return {data.data() + view.byteOffset + offset, view.byteStride ? view.byteStride : element_bytes};
}

const tinygltf::Accessor& accessor_at(const tinygltf::Model& model, int index) {
  return model.accessors[static_cast<std::size_t>(index)];
}

template <class C>
float to_float(C value, bool normalized) {
  if constexpr (std::is_floating_point_v<C>) return value;
  const float number = static_cast<float>(value);
  if (!normalized) return number;
  return std::max(number / static_cast<float>(std::numeric_limits<C>::max()), -1.0f);
}

// Calls visit(C{}) with the component's type.
template <class Visit>
void with_component_type(int component_type, Visit visit) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return visit(std::int8_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return visit(std::uint8_t{});
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return visit(std::int16_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return visit(std::uint16_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return visit(std::uint32_t{});
    default:
      return visit(float{});
  }
}

template <class C, class Store>
void copy_element(const std::uint8_t* from, std::size_t components, Store store) {
  for (std::size_t i = 0; i < components; ++i) {
    C value;
    std::memcpy(&value, from + i * sizeof(C), sizeof(C));
    store(i, value);
  }
}

std::vector<std::uint32_t> sparse_places(const Report& report, const tinygltf::Model& model,
                                         const tinygltf::Accessor& accessor, const std::string& where) {
  const auto& sparse = accessor.sparse;
  const auto bytes =
      static_cast<std::size_t>(component_bytes(static_cast<std::uint64_t>(sparse.indices.componentType)));
  const Elements from = elements_at(model, sparse.indices.bufferView,
                                    static_cast<std::size_t>(sparse.indices.byteOffset), bytes);
  std::vector<std::uint32_t> places(static_cast<std::size_t>(sparse.count));
  with_component_type(sparse.indices.componentType, [&]<class C>(C) {
    for (std::size_t i = 0; i < places.size(); ++i)
      copy_element<C>(from.first + i * bytes, 1,
                      [&](std::size_t, C v) { places[i] = static_cast<std::uint32_t>(v); });
  });
  for (const std::uint32_t place : places)
    if (place >= accessor.count)
      report.fail("S009", where + ": sparse index " + std::to_string(place) +
                              " is not below the accessor's count " + std::to_string(accessor.count));
  return places;
}

// Every element, sparse ones replaced: store(element, component, value).
template <class Store>
void for_each_component(const Report& report, const tinygltf::Model& model,
                        const tinygltf::Accessor& accessor, const std::string& where, Store store) {
  const auto components =
      static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
  with_component_type(accessor.componentType, [&]<class C>(C) {
    const std::size_t bytes = components * sizeof(C);
    const Elements dense = elements_at(model, accessor.bufferView, accessor.byteOffset, bytes);
    for (std::size_t e = 0; dense.first && e < accessor.count; ++e)
      copy_element<C>(dense.first + e * dense.stride, components,
                      [&](std::size_t i, C v) { store(e, i, v); });
    if (!accessor.sparse.isSparse) return;
    const auto places = sparse_places(report, model, accessor, where);
    const std::uint8_t* values =
        elements_at(model, accessor.sparse.values.bufferView,
                    static_cast<std::size_t>(accessor.sparse.values.byteOffset), bytes)
            .first;
    for (std::size_t s = 0; s < places.size(); ++s)
      copy_element<C>(values + s * bytes, components, [&](std::size_t i, C v) { store(places[s], i, v); });
  });
}

}  // namespace

void require_components(const Report& report, const tinygltf::Model& model, const AccessorUse& use) {
  const tinygltf::Accessor& accessor = accessor_at(model, use.accessor);
  if (tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)) != use.components)
    report.fail("S004", use.where + ": " + element("accessors", static_cast<std::size_t>(use.accessor)) +
                            " must have " + std::to_string(use.components) + " components");
}

void read_floats(const Report& report, const tinygltf::Model& model, const AccessorUse& use,
                 std::span<float> out) {
  const auto components = static_cast<std::size_t>(use.components);
  const tinygltf::Accessor& accessor = accessor_at(model, use.accessor);
  for_each_component(report, model, accessor, use.where, [&](std::size_t e, std::size_t i, auto value) {
    out[e * components + i] = to_float(value, use.normalized);
  });
  const auto bad = std::find_if(out.begin(), out.end(), [](float v) { return !std::isfinite(v); });
  if (bad != out.end())
    report.fail(
        "S010",
        use.where + ": element " + std::to_string((bad - out.begin()) / use.components) +
            " is not a finite number",
        "the exporter wrote NaN or infinity: repair the mesh (remove degenerate data) and export again");
}

std::vector<float> read_floats(const Report& report, const tinygltf::Model& model, const AccessorUse& use) {
  require_components(report, model, use);
  std::vector<float> out(accessor_at(model, use.accessor).count * static_cast<std::size_t>(use.components));
  read_floats(report, model, use, out);
  return out;
}

std::vector<std::uint32_t> read_indices(const Report& report, const tinygltf::Model& model, int index,
                                        const std::string& where) {
  const tinygltf::Accessor& accessor = accessor_at(model, index);
  const int type = accessor.componentType;
  if (accessor.type != TINYGLTF_TYPE_SCALAR ||
      (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
       type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT))
    report.fail("S004", where + ": indices must be unsigned scalars of 8, 16 or 32 bits");
  std::vector<std::uint32_t> out(accessor.count);
  for_each_component(report, model, accessor, where, [&](std::size_t e, std::size_t, auto value) {
    out[e] = static_cast<std::uint32_t>(value);
  });
  return out;
}

int element_bytes(const tinygltf::Model& model, int index) {
  const tinygltf::Accessor& accessor = accessor_at(model, index);
  return component_bytes(static_cast<std::uint64_t>(accessor.componentType)) *
         tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
}

}  // namespace hwsim::pipeline::gltf
