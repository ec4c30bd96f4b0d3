#include "pipeline/gltf/ranges.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>

namespace hwsim::pipeline::gltf {
namespace {
using nlohmann::json;

constexpr std::size_t kMaxErrors = 20;
constexpr std::uint64_t kMaxCount = 0xffffffffu;  // an index has 32 bits

std::uint64_t count_of(const json& object, const char* key, std::uint64_t otherwise = 0) {
  const auto found = object.find(key);
  return found == object.end() ? otherwise : static_cast<std::uint64_t>(found->get<double>());
}

class RangeChecker {
 public:
  RangeChecker(const Report& report, const json& root) : report_(report), root_(root) {}

  void buffers() {
    each("buffers", [&](const json& buffer, std::size_t i) {
      if (count_of(buffer, "byteLength") == 0)
        add("S007", element("buffers", i) + ".byteLength is 0, must be positive");
    });
  }

  void buffer_views() {
    each("bufferViews", [&](const json& view, std::size_t i) {
      const std::uint64_t buffer_bytes = count_of(root_["buffers"][count_of(view, "buffer")], "byteLength");
      const std::uint64_t offset = count_of(view, "byteOffset"), bytes = count_of(view, "byteLength");
      if (bytes == 0) add("S008", element("bufferViews", i) + ".byteLength is 0, must be positive");
      if (offset + bytes > buffer_bytes)
        add("S008", element("bufferViews", i) + " ends at byte " + std::to_string(offset + bytes) +
                        " of a buffer of " + std::to_string(buffer_bytes) + " bytes");
      if (count_of(view, "byteStride") > 252)
        add("S008", element("bufferViews", i) + ".byteStride is above 252");
    });
  }

  void accessors() {
    each("accessors", [&](const json& accessor, std::size_t i) {
      const std::string where = element("accessors", i);
      const auto component = static_cast<std::uint64_t>(component_bytes(count_of(accessor, "componentType")));
      const auto components =
          static_cast<std::uint64_t>(component_count(accessor["type"].get<std::string>()));
      const std::uint64_t count = count_of(accessor, "count");
      if (component == 0)
        add("S004", where + ".componentType " + accessor["componentType"].dump() + " does not exist");
      if (components == 0) add("S004", where + ".type " + accessor["type"].dump() + " does not exist");
      if (count == 0 || count > kMaxCount)
        add("S008", where + ".count is " + std::to_string(count) + ", must be from 1 to 4294967295");
      if (component == 0 || components == 0 || count == 0 || count > kMaxCount) return;
      if (accessor.contains("bufferView"))
        fits(where, accessor, count, component * components, component);
      else
        unbacked(where, count);
      if (accessor.contains("sparse")) sparse(where, accessor["sparse"], count, component * components);
    });
  }

  void images() {
    each("images", [&](const json& image, std::size_t i) {
      if (image.contains("uri") == image.contains("bufferView"))
        add("S004", element("images", i) + " must have either a uri or a bufferView");
    });
  }

  void scenes() {
    if (!root_.contains("scenes") || root_["scenes"].empty())
      errors_.push_back(
          report_.error("S014", "the file has no scene", "export with a scene, or add one to the file"));
  }

  std::vector<Diagnostic> take() { return std::move(errors_); }

 private:
  // An accessor without a view is all zeros and takes no bytes in the file: bounded, or a 200-byte file fills
  // memory.
  static constexpr std::uint64_t kMaxUnbacked = 1u << 24;

  void unbacked(const std::string& where, std::uint64_t count) {
    if (count > kMaxUnbacked)
      add("S012", where + " has " + std::to_string(count) + " elements but no bufferView; the limit is " +
                      std::to_string(kMaxUnbacked));
  }

  template <class Check>
  void each(const char* array, Check check) {
    const auto found = root_.find(array);
    if (found == root_.end()) return;
    for (std::size_t i = 0; i < found->size() && errors_.size() < kMaxErrors; ++i) check((*found)[i], i);
  }

  void fits(const std::string& where, const json& holder, std::uint64_t count, std::uint64_t element_bytes,
            std::uint64_t component) {
    const json& view = root_["bufferViews"][count_of(holder, "bufferView")];
    const std::uint64_t stride = count_of(view, "byteStride", element_bytes);
    const std::uint64_t offset = count_of(holder, "byteOffset");
    if (stride != 0 && stride < element_bytes)
      return add("S008", where + " has elements of " + std::to_string(element_bytes) +
                             " bytes at a stride of " + std::to_string(stride));
    if (stride % component != 0)
      return add("S008", where + ": the stride of " + std::to_string(stride) +
                             " is not a multiple of the component's " + std::to_string(component) + " bytes");
    const std::uint64_t end = offset + (stride ? stride : element_bytes) * (count - 1) + element_bytes;
    if (end > count_of(view, "byteLength"))
      add("S008", where + " ends at byte " + std::to_string(end) + " of a buffer view of " +
                      std::to_string(count_of(view, "byteLength")) + " bytes");
  }

  void sparse(const std::string& where, const json& sparse, std::uint64_t count,
              std::uint64_t element_bytes) {
    const std::uint64_t sparse_count = count_of(sparse, "count");
    if (sparse_count == 0 || sparse_count > std::min<std::uint64_t>(count, 0x7fffffff))
      return add("S008", where + ".sparse.count is " + std::to_string(sparse_count) +
                             ", must be from 1 to the count");
    const std::uint64_t type = count_of(sparse["indices"], "componentType");
    if (type != 5121 && type != 5123 && type != 5125)
      return add("S004", where + ".sparse.indices.componentType must be 5121, 5123 or 5125");
    const auto index_bytes = static_cast<std::uint64_t>(component_bytes(type));
    dense_fits(where + ".sparse.indices", sparse["indices"], sparse_count * index_bytes);
    dense_fits(where + ".sparse.values", sparse["values"], sparse_count * element_bytes);
  }

  void dense_fits(const std::string& where, const json& holder, std::uint64_t bytes) {
    const json& view = root_["bufferViews"][count_of(holder, "bufferView")];
    const std::uint64_t end = count_of(holder, "byteOffset") + bytes;
    if (end > count_of(view, "byteLength") || end > 0x7fffffff)  // tinygltf keeps these offsets in an int
      add("S008", where + " ends at byte " + std::to_string(end) + " of a buffer view of " +
                      std::to_string(count_of(view, "byteLength")) + " bytes");
  }

  void add(const char* code, const std::string& message) {
    if (errors_.size() < kMaxErrors) errors_.push_back(report_.error(code, message));
  }

  const Report& report_;
  const json& root_;
  std::vector<Diagnostic> errors_;
};

}  // namespace

int component_bytes(std::uint64_t component_type) {
  switch (component_type) {
    case 5120:
    case 5121:
      return 1;
    case 5122:
    case 5123:
      return 2;
    case 5125:
    case 5126:
      return 4;
    default:
      return 0;
  }
}

int component_count(std::string_view type) {
  constexpr std::array<std::pair<std::string_view, int>, 7> kCounts = {
      {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}}};
  for (const auto& [name, count] : kCounts)
    if (name == type) return count;
  return 0;
}

std::vector<Diagnostic> check_ranges(const Report& report, const json& root) {
  RangeChecker checker(report, root);
  checker.scenes();
  checker.buffers();
  checker.buffer_views();
  checker.accessors();
  checker.images();
  return checker.take();
}

}  // namespace hwsim::pipeline::gltf
