#include "pipeline/gltf/source.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "hwsim/base/content_hash.h"
#include "pipeline/gltf/container.h"
#include "pipeline/gltf/rules.h"

namespace hwsim::pipeline::gltf {
namespace {
using nlohmann::json;

// tinygltf's callbacks take one pointer.
struct Callbacks {
  std::string folder;
  std::size_t max_file_bytes = 0;
  std::map<std::string, std::size_t> declared_bytes;  ///< external buffers' sizes, by decoded URI
  ContentHash hash;
  std::set<std::string> files;
  std::vector<std::vector<std::uint8_t>> images;
};

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string percent_decoded(const std::string& uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size() && hex_digit(uri[i + 1]) >= 0 && hex_digit(uri[i + 2]) >= 0) {
      out += static_cast<char>(hex_digit(uri[i + 1]) * 16 + hex_digit(uri[i + 2]));
      i += 2;
    } else {
      out += uri[i];
    }
  }
  return out;
}

// tinygltf would also look in the current directory: a scene must not depend on where the program was
// started.
bool exists_in_folder(const std::string& path, void* user) {
  auto& callbacks = *static_cast<Callbacks*>(user);
  std::error_code error;
  callbacks.files.insert(path);
  return path.rfind(callbacks.folder, 0) == 0 && std::filesystem::is_regular_file(path, error);
}

std::string same_path(const std::string& path, void*) { return path; }

bool read_external(std::vector<unsigned char>* out, std::string* error, const std::string& path, void* user) {
  auto& callbacks = *static_cast<Callbacks*>(user);
  if (!read_bytes(path, callbacks.max_file_bytes, *out)) {
    *error = "cannot be read, or is larger than " + std::to_string(callbacks.max_file_bytes) + " bytes";
    return false;
  }
  callbacks.hash.add(*out);
  // glTF lets a buffer's file be longer than byteLength; tinygltf wants them equal.
  const std::string relative = path.substr(std::min(path.size(), callbacks.folder.size() + 1));
  const auto declared = callbacks.declared_bytes.find(relative);
  if (declared != callbacks.declared_bytes.end() && declared->second < out->size())
    out->resize(declared->second);
  return true;
}

bool write_nothing(std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
  return false;
}

bool keep_image(tinygltf::Image*, const int index, std::string*, std::string*, int, int,
                const unsigned char* bytes, int size, void* user) {
  auto& images = static_cast<Callbacks*>(user)->images;
  const auto place = static_cast<std::size_t>(index);
  if (place < images.size() && size > 0) images[place].assign(bytes, bytes + size);
  return true;
}

void declare_external_buffers(Callbacks& callbacks, const json& root) {
  if (!root.contains("buffers")) return;
  for (const json& buffer : root["buffers"])
    if (buffer.contains("uri"))
      callbacks.declared_bytes[percent_decoded(buffer["uri"].get<std::string>())] =
          static_cast<std::size_t>(buffer["byteLength"].get<double>());
}

std::string first_line(const std::string& text) {
  const std::string line = text.substr(0, text.find('\n'));
  return line.size() > 200 ? line.substr(0, 197) + "..." : line;
}

void parse(Report& report, const Container& c, Callbacks& callbacks, tinygltf::Model& model) {
  tinygltf::TinyGLTF parser;
  parser.SetImageLoader(keep_image, &callbacks);
  parser.SetFsCallbacks({exists_in_folder, same_path, read_external, write_nothing, &callbacks});
  std::string error, warning;
  bool parsed = false;
  try {
    const auto size = static_cast<unsigned>(c.bytes.size());
    parsed = c.binary ? parser.LoadBinaryFromMemory(&model, &error, &warning, c.bytes.data(), size,
                                                    callbacks.folder)
                      : parser.LoadASCIIFromString(&model, &error, &warning,
                                                   reinterpret_cast<const char*>(c.bytes.data()), size,
                                                   callbacks.folder);
  } catch (const std::exception& e) {
    error = e.what();
  }
  if (parsed) return;
  const bool is_file = error.find("File ") != std::string::npos;
  report.fail(
      is_file ? "S007" : "S004", "the glTF cannot be read: " + first_line(error),
      is_file ? "a buffer's file must lie beside the .gltf file under the name that its uri gives" : "");
}

// tinygltf lets a failed buffer pass with too few bytes in some paths; the ranges were checked against
// byteLength.
void check_buffers_complete(const Report& report, const json& root, const tinygltf::Model& model) {
  if (!root.contains("buffers")) return;
  for (std::size_t i = 0; i < root["buffers"].size(); ++i) {
    const double declared = root["buffers"][i]["byteLength"].get<double>();
    const double got = i < model.buffers.size() ? static_cast<double>(model.buffers[i].data.size()) : 0.0;
    if (got < declared)
      report.fail("S007", element("buffers", i) + " holds " +
                              std::to_string(static_cast<std::uint64_t>(got)) + " bytes, byteLength says " +
                              std::to_string(static_cast<std::uint64_t>(declared)));
  }
}

}  // namespace

Source read_source(Report& report, const SceneLoadOptions& options) {
  const Container container = read_container(report, options.max_file_bytes);
  const json root = parse_json(report, container.json());
  check_rules(report, root, container.bin_bytes, container.binary);

  Callbacks callbacks;
  std::error_code error;
  const std::filesystem::path file = std::filesystem::absolute(report.file(), error);
  callbacks.folder = file.parent_path().string();
  callbacks.files.insert(file.string());
  callbacks.max_file_bytes = options.max_file_bytes;
  callbacks.hash.add(container.bytes);
  callbacks.images.resize(root.contains("images") ? root["images"].size() : 0);
  declare_external_buffers(callbacks, root);

  Source source;
  parse(report, container, callbacks, source.model);
  check_buffers_complete(report, root, source.model);
  source.images = std::move(callbacks.images);
  source.content_hash = callbacks.hash.hex();
  source.files.assign(callbacks.files.begin(), callbacks.files.end());
  return source;
}

}  // namespace hwsim::pipeline::gltf
