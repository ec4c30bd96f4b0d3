#include "pipeline/open/scene_source.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <system_error>
#include <utility>

#include "hwsim/base/content_hash.h"
#include "hwsim/base/file_name.h"
#include "pipeline/base/sealed_file.h"
#include "pipeline/generate/generator_digest.h"
#include "pipeline/generate/registry.h"
#include "pipeline/gltf/gltf_loader.h"

namespace hwsim::pipeline {
namespace {
using Values = std::map<std::string, double>;

[[noreturn]] void fail(const std::string& code, const std::string& message, const std::string& hint = "",
                       const std::string& help = "") {
  Diagnostic d;
  d.code = code;
  d.message = message;
  d.hint = hint;
  d.help = help;
  throw InputError(d);
}

std::string shown(double value) {
  char text[400];  // the largest double has 309 digits
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed)
                       .ptr;  // the shortest text that reads back the same
  return {text, end};
}

std::string joined(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

[[noreturn]] void fail_unknown(const std::string& code, const std::string& what, const std::string& name,
                               const std::vector<std::string>& candidates) {
  fail(code, "unknown " + what + " `" + name + "`", did_you_mean(name, candidates),
       "known: " + joined(candidates));
}

const generate::Generator& find_generator(const std::string& name) {
  std::vector<std::string> names;
  for (const generate::Generator& generator : generate::registry()) {
    if (generator.info.name == name) return generator;
    names.push_back(generator.info.name);
  }
  fail_unknown("S201", "scene", name, names);
}

// Every parameter of the generator, the given values over the defaults.
Values complete_parameters(const GeneratorInfo& info, const Values& given) {
  Values out;
  std::vector<std::string> names;
  for (const GeneratorParameter& p : info.parameters) {
    out[p.name] = p.default_value;
    names.push_back(p.name);
  }
  for (const auto& [name, value] : given) {
    const auto p =
        std::find_if(info.parameters.begin(), info.parameters.end(),
                     [&, &wanted = name](const GeneratorParameter& q) { return q.name == wanted; });
    if (p == info.parameters.end()) fail_unknown("S202", "parameter of " + info.name, name, names);
    if (!(value >= p->min && value <= p->max))
      fail("S203", info.name + ":" + name + " = " + shown(value) + ", must be between " + shown(p->min) +
                       " and " + shown(p->max));
    out[name] = value;
  }
  return out;
}

// "name:key=value,key=value"
std::pair<std::string, Values> parse_spec(const std::string& spec) {
  const std::size_t colon = spec.find(':');
  std::pair<std::string, Values> out{spec.substr(0, colon), {}};
  std::string rest = colon == std::string::npos ? "" : spec.substr(colon + 1);
  while (!rest.empty()) {
    const std::string item = rest.substr(0, rest.find(','));
    rest.erase(0, item.size() + 1);
    const std::size_t equals = item.find('=');
    double value = 0.0;
    const char* first = item.data() + (equals == std::string::npos ? item.size() : equals + 1);
    const auto [end, error] = std::from_chars(first, item.data() + item.size(), value);
    if (equals == std::string::npos || error != std::errc() || end != item.data() + item.size())
      fail("S204", "`" + item + "` in `" + spec + "` is not of the form key=number", "",
           "e.g. grass:blades=20000,seed=3");
    if (!out.second.emplace(item.substr(0, equals), value).second)
      fail("S204", "`" + item.substr(0, equals) + "` is given twice in `" + spec + "`");
  }
  return out;
}

std::string cache_file_name(const std::string& name, const Values& values) {
  std::string key = name + " by " + std::string(generator_digest());
  for (const auto& [parameter, value] : values) key += ' ' + parameter + '=' + shown(value);
  ContentHash hash;
  hash.add({reinterpret_cast<const std::uint8_t*>(key.data()), key.size()});
  return name + "-" + hash.hex().substr(0, 16) + ".glb";
}

std::vector<std::uint8_t> make_glb(const generate::Generator& generator, const Values& values) {
  std::vector<std::uint8_t> bytes = generate::encode_glb(generator.make(generate::Parameters(values)));
  if (bytes.size() > std::numeric_limits<std::uint32_t>::max())
    fail("S205", generator.info.name + " with these parameters is larger than a GLB file may be (4 GiB)");
  return bytes;
}

bool is_file_name(const std::string& name) {
  return has_extension(name, ".gltf") || has_extension(name, ".glb");
}

/// From the cache, or made now and kept there.
std::vector<std::uint8_t> generated_glb(const generate::Generator& generator, const Values& values,
                                        const std::string& folder, const NoteFunction& note) {
  if (folder.empty()) return make_glb(generator, values);
  if (const std::string fault = make_private_folder(folder); !fault.empty()) {
    note(unwritable_note(folder, fault));
    return make_glb(generator, values);
  }
  const std::string path =
      (std::filesystem::path(folder) / cache_file_name(generator.info.name, values)).string();
  const SealKind kind{"glb", generator_digest()};
  SealedContent kept = read_sealed(path, kind);
  if (kept.bytes) return std::move(*kept.bytes);
  if (!kept.damage.empty()) note(damage_note(path, kept.damage));
  std::vector<std::uint8_t> bytes = make_glb(generator, values);
  try {
    write_sealed(path, kind, "K002", bytes);
  } catch (const InputError& error) {
    note(unwritable_note(folder, error.what()));
  }
  return bytes;
}

Scene open_generated(const std::string& spec, const std::string& cache_directory,
                     const SceneLoadOptions& options, const NoteFunction& note) {
  const auto [name, given] = parse_spec(spec);
  const generate::Generator& generator = find_generator(name);
  const Values values = complete_parameters(generator.info, given);
  const NoteFunction silent = [](const Diagnostic&) {};
  Scene scene =
      load_glb(generated_glb(generator, values, cache_directory, note ? note : silent), spec, options);
  scene.name = spec;
  scene.files.clear();  // it came from no file
  return scene;
}

Diagnostic note_on(const std::string& file, const std::string& code, const std::string& message,
                   const std::string& help, std::string consequence) {
  Diagnostic note{.severity = Severity::note, .code = code, .message = message};
  note.place.file = file;
  note.help = help;
  note.notes = {std::move(consequence)};
  return note;
}

}  // namespace

std::span<const GeneratorInfo> generators() {
  static const std::vector<GeneratorInfo> infos = [] {  // constant data
    std::vector<GeneratorInfo> out;
    for (const generate::Generator& generator : generate::registry()) out.push_back(generator.info);
    return out;
  }();
  return infos;
}

void write_generated_scene(const std::string& name, const std::map<std::string, double>& parameters,
                           const std::string& path) {
  const generate::Generator& generator = find_generator(name);
  write_file_atomically(path, "S206", make_glb(generator, complete_parameters(generator.info, parameters)));
}

Scene open_scene(const std::string& name_or_path, const std::string& cache_directory,
                 const SceneLoadOptions& options, const NoteFunction& note) {
  return is_file_name(name_or_path) ? load_gltf(name_or_path, options)
                                    : open_generated(name_or_path, cache_directory, options, note);
}

Diagnostic damage_note(const std::string& path, const std::string& reason) {
  return note_on(path, "K001", "a file of the cache is damaged (" + reason + ") and is made anew",
                 "nothing needs to be done", "results are not affected");
}

Diagnostic unwritable_note(const std::string& folder, const std::string& reason) {
  return note_on(folder, "K002", "the cache cannot be used: " + reason,
                 "set HWSIM_CACHE to a folder of your own that has space",
                 "results are not affected; the next run will do this work again");
}

}  // namespace hwsim::pipeline
