// From files and assignments to a GpuConfig: parents first, then the file, overlays, `--set`; ranges and
// rules last.
#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "hwsim/base/diagnostics.h"
#include "hwsim/base/file_name.h"
#include "hwsim/config/assign.h"
#include "hwsim/config/toml_file.h"
#include "hwsim/gpu/gpu_config.h"
#include "hwsim/gpu/gpu_files.h"
#include "hwsim/gpu/gpu_keys.h"
#include "hwsim/gpu/gpu_rules.h"
#include "hwsim/gpu/sheet_words.h"

namespace hwsim {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kChainMax = 16;    // files from a GPU to the one that stands alone
constexpr std::size_t kIdBytesMax = 64;  // ids become names of folders and columns
constexpr std::string_view kSchemaHelp = "`hwsim config schema gpu` lists the keys";

struct Resolved {
  TomlEntry entry;
  Origin origin;
  std::string word;  ///< a data sheet's, that was written in place of the key; empty: the key itself
};

/// The keys that say what a file is, not what the GPU is.
struct Header {
  std::string id, extends;
  SourcePlace extends_place;
};

bool is_path(const std::string& id_or_path) {
  return has_extension(id_or_path, ".toml") || id_or_path.find('/') != std::string::npos;
}

/// What can name a folder: no slashes, no control characters, not too long.
bool is_name(const std::string& id) {
  const auto printable = [](char c) { return static_cast<unsigned char>(c) >= 0x20 && c != 0x7f; };
  return !id.empty() && id.size() <= kIdBytesMax && id.find_first_of("/\\") == std::string::npos &&
         std::all_of(id.begin(), id.end(), printable) && id != "." && id != "..";
}

std::optional<Provenance> provenance_from_name(std::string_view name) {
  for (const auto p : {Provenance::published, Provenance::measured, Provenance::fitted, Provenance::derived,
                       Provenance::assumed})
    if (provenance_name(p) == name) return p;
  return std::nullopt;
}

}  // namespace

class GpuFiles::Loader {
 public:
  Loader(std::string config_dir, std::string preferred_dir)
      : config_dir_(std::move(config_dir)),
        preferred_dir_(std::move(preferred_dir)),
        keys_(keys_of(config_)) {}
  Loader(const Loader& other)
      : config_dir_(other.config_dir_),
        preferred_dir_(other.preferred_dir_),
        base_path_(other.base_path_),
        config_(other.config_),
        keys_(keys_of(config_)),
        resolved_(other.resolved_),
        problems_(other.problems_),
        base_missing_(other.base_missing_) {}
  Loader& operator=(const Loader&) = delete;

  void base(const std::string& id_or_path) {
    const auto path = find(id_or_path, "", {});
    if (!path) return;
    base_path_ = *path;
    config_.id = file_with_parents(*path, Origin::Layer::file, {});
  }

  void overlay(const std::string& path) { read(path, "overlay", Origin::Layer::overlay); }

  void set(const Assignment& assignment) {
    if (assignment.group() != "gpu") return;
    Resolved resolved;
    resolved.entry.path =
        assignment.path.substr(std::min(assignment.path.size(), std::string("gpu.").size()));
    resolved.entry.key_place = command_line_place(assignment, false);
    resolved.entry.value_place = command_line_place(assignment, true);
    resolved.origin.layer = Origin::Layer::command_line;
    resolved.entry.value = value_of_assignment(assignment, problems_);
    if (!resolved.entry.value) return;
    add(std::move(resolved), "gpu \"" + config_.id + "\"");
  }

  GpuConfig finish() {
    if (!base_missing_)
      for (const Key& key : keys_) settle(key);
    if (problems_.empty()) check_rules(config_, problems_);
    if (!problems_.empty()) throw InputError(std::move(problems_));
    return std::move(config_);
  }

 private:
  /// The parent's values first, so that a child's unknown key can say what it would have replaced. Returns
  /// the id.
  std::string file_with_parents(const std::string& path, Origin::Layer layer,
                                std::vector<std::string> chain) {
    std::error_code error;
    const std::string identity = fs::weakly_canonical(path, error).string();
    chain.push_back(identity);
    std::vector<TomlEntry> entries;
    const Header header = read_header(path, "gpu", entries);
    const std::string id = header.id.empty() ? fs::path(path).stem().string() : header.id;
    if (!header.extends.empty()) extend(header, path, chain);
    for (TomlEntry& entry : entries) add_from_file(std::move(entry), path, layer, "gpu \"" + id + "\"");
    return id;
  }

  void extend(const Header& header, const std::string& child, const std::vector<std::string>& chain) {
    const auto parent = find(header.extends, child, header.extends_place);
    if (!parent) return;
    std::error_code error;
    const std::string identity = fs::weakly_canonical(*parent, error).string();
    const bool circle = std::find(chain.begin(), chain.end(), identity) != chain.end();
    if (!circle && chain.size() < kChainMax) {
      std::string id =
          file_with_parents(*parent, Origin::Layer::parent, chain);  // adds its own parents first
      config_.parents.insert(config_.parents.begin(), std::move(id));
      return;
    }
    Diagnostic d;
    d.code = "C017";
    d.message = circle ? "`extends` goes in a circle"
                       : "more than " + std::to_string(kChainMax) + " files extend each other";
    d.place = header.extends_place;
    if (circle) d.notes = chain;
    d.notes.push_back(identity + (circle ? " again" : " would be the next"));
    d.help = circle ? "one file of the chain must stand alone" : "write the values of several files into one";
    problems_.push_back(std::move(d));
    base_missing_ = true;
  }

  void read(const std::string& path, const char* kind, Origin::Layer layer) {
    std::vector<TomlEntry> entries;
    const Header header = read_header(path, kind, entries);
    if (!header.extends.empty()) complain_header("an overlay has no `extends`", header.extends_place);
    for (TomlEntry& entry : entries)
      add_from_file(std::move(entry), path, layer, "overlay \"" + fs::path(path).stem().string() + "\"");
  }

  Header read_header(const std::string& path, const std::string& kind, std::vector<TomlEntry>& rest) {
    const std::size_t before = problems_.size();
    TomlFile file = read_toml_file(path, problems_);
    Header header;
    bool has_schema = false, has_kind = false;
    for (TomlEntry& entry : file.entries) {
      const auto* text = entry.value ? std::get_if<std::string>(&*entry.value) : nullptr;
      if (entry.path == "schema") {
        has_schema = true;
        if (!entry.value || *entry.value != TomlValue(std::int64_t{1}))
          complain_header("`schema` must be 1", entry.value_place);
      } else if (entry.path == "kind") {
        has_kind = true;
        if (!text || *text != kind)
          complain_header("`kind` must be \"" + kind + "\" here", entry.value_place);
      } else if (entry.path == "about" && kind == "overlay") {
        if (!text) complain_header("`about` must be a text", entry.value_place);
      } else if (entry.path == "id" || entry.path == "extends") {
        if (!text || text->empty())
          complain_header("`" + entry.path + "` must be a text", entry.value_place);
        else if (entry.path == "id" && !is_name(*text))
          complain_header("`id` must be of 1 to 64 printable characters, without slashes", entry.value_place);
        if (text) (entry.path == "id" ? header.id : header.extends) = *text;
        if (entry.path == "extends") header.extends_place = entry.value_place;
      } else {
        rest.push_back(std::move(entry));
      }
    }
    const bool readable = problems_.size() == before || !file.entries.empty();
    if (!readable) base_missing_ = base_missing_ || kind == "gpu";
    SourcePlace place;
    place.file = path;
    if (readable && !has_schema) complain_header("`schema = 1` is missing", place);
    if (readable && !has_kind) complain_header("`kind = \"" + kind + "\"` is missing", place);
    return header;
  }

  void complain_header(std::string message, SourcePlace place) {
    Diagnostic d;
    d.code = "C019";
    d.message = std::move(message);
    d.place = std::move(place);
    d.help =
        "a GPU file begins with schema = 1, kind = \"gpu\", id = \"...\"; an overlay with kind = \"overlay\"";
    problems_.push_back(std::move(d));
  }

  /// `child`: the file that extends `name`; a file may extend the one that it takes the place of, by its id.
  std::optional<std::string> find(const std::string& name, const std::string& child, SourcePlace place) {
    std::error_code error;
    const std::string folder = fs::path(child).parent_path().string();
    if (is_path(name)) {
      const fs::path path =
          fs::path(name).is_absolute() || folder.empty() ? fs::path(name) : fs::path(folder) / name;
      if (fs::is_regular_file(path, error)) return path.string();
    } else {
      std::optional<std::string> itself;
      for (const std::string& dir : {preferred_dir_, folder, config_dir_}) {
        const fs::path path = fs::path(dir) / (name + ".toml");
        if (dir.empty() || !fs::is_regular_file(path, error)) continue;
        if (!fs::equivalent(path, fs::path(child), error)) return path.string();
        itself = path.string();
      }
      if (itself) return itself;
    }
    problems_.push_back(unknown_gpu(name, std::move(place)));
    base_missing_ = true;
    return std::nullopt;
  }

  Diagnostic unknown_gpu(const std::string& name, SourcePlace place) const {
    Diagnostic d;
    d.code = is_path(name) ? "C010" : "C016";
    d.message = is_path(name) ? "cannot read the file `" + name + "`" : "unknown GPU \"" + name + "\"";
    d.place = std::move(place);
    const std::vector<std::string> gpus = list_gpus(config_dir_);
    d.hint = did_you_mean(fs::path(name).stem().string(), gpus);
    std::string known;
    for (const std::string& gpu : gpus) known += " " + gpu;
    d.notes.push_back(gpus.empty() ? "there are no GPU files in `" + config_dir_ + "`" : "known:" + known);
    d.help = "give an id, or the path of a .toml file";
    return d;
  }

  void add_from_file(TomlEntry entry, const std::string& path, Origin::Layer layer,
                     const std::string& subject) {
    Resolved resolved;
    resolved.origin.layer = layer;
    resolved.origin.file = path;
    resolved.origin.line = entry.key_place.line;
    resolved.origin.source = entry.source;
    resolved.origin.interval = entry.interval;
    if (!entry.provenance.empty()) resolved.origin.provenance = checked_provenance(entry);
    resolved.entry = std::move(entry);
    add(std::move(resolved), subject);
  }

  std::optional<Provenance> checked_provenance(const TomlEntry& entry) {
    const auto provenance = provenance_from_name(entry.provenance);
    if (provenance) return provenance;
    static const std::vector<std::string> kNames = {"published", "measured", "fitted", "derived", "assumed"};
    Diagnostic d;
    d.code = "C022";
    d.message = "unknown provenance \"" + entry.provenance + "\" of `" + entry.path + "`";
    d.place = entry.provenance_place;
    d.hint = did_you_mean(entry.provenance, kNames);
    d.help = "it is one of published, measured, fitted, derived, assumed";
    problems_.push_back(std::move(d));
    return std::nullopt;
  }

  /// A file that says a number twice, by two of its names, does not say which one holds.
  bool is_said_twice(const Resolved& resolved) {
    const auto before = resolved_.find(resolved.entry.path);
    if (before == resolved_.end() || before->second.word == resolved.word ||
        before->second.origin.layer != resolved.origin.layer ||
        before->second.origin.file != resolved.origin.file)
      return false;
    const std::string other = before->second.word.empty() ? resolved.entry.path : before->second.word;
    const std::string own = resolved.word.empty() ? resolved.entry.path : resolved.word;
    Diagnostic d;
    d.code = "C025";
    d.message = "`" + own + "` and `" + other + "` are the same number";
    d.place = resolved.entry.key_place;
    d.help = "leave one of them out";
    problems_.push_back(std::move(d));
    return true;
  }

  void add(Resolved resolved, const std::string& subject) {
    if (const SheetWord* word = find_sheet_word(resolved.entry.path)) {
      resolved.word = resolved.entry.path;
      translate(*word, resolved.entry);
    }
    if (is_said_twice(resolved)) return;
    const std::string name = resolved.entry.path;
    const Key* key = find_key(keys_, name);
    if (!key && problems_.size() >= kProblemsShown) {
      problems_.emplace_back();  // counted; nobody reads it
      return;
    }
    if (!key) {
      Diagnostic d = unknown_key(keys_, name, subject, resolved.entry.key_place);
      d.hint = unknown_key_hint(keys_, resolved.entry, d.hint);
      const auto inherited = resolved_.find(nearest_key(keys_, name));
      if (inherited != resolved_.end() && inherited->second.entry.value && inherited->second.origin.line > 0)
        d.notes.push_back("inherited value " + to_toml(*inherited->second.entry.value) + " from " +
                          fs::path(inherited->second.origin.file).filename().string() + ":" +
                          std::to_string(inherited->second.origin.line));
      d.help = kSchemaHelp;
      problems_.push_back(std::move(d));
      return;
    }
    scale_inherited(*key, resolved.entry);
    if (!resolved.entry.value) {
      Diagnostic d;
      d.code = "C013";
      d.message = "`" + name + "` is a " + resolved.entry.found_type + ", must be a " +
                  std::string(expected_type(*key));
      d.place = resolved.entry.value_place;
      d.help = "write " + name + " = VALUE, or { value = VALUE, provenance = \"...\", source = \"...\" }";
      problems_.push_back(std::move(d));
    }
    resolved_.insert_or_assign(name, std::move(resolved));
  }

  /// "x2" doubles what the layers below say. Derived values follow, because they are derived last.
  void scale_inherited(const Key& key, TomlEntry& entry) {
    const auto factor = entry.value ? scale_factor(key, *entry.value) : std::nullopt;
    if (!factor) return;
    const auto below = resolved_.find(key.info.name);
    const bool has_value = below != resolved_.end() && below->second.entry.value;
    entry.value = scaled(has_value ? *below->second.entry.value : value_in(key.slot), *factor);
  }

  void settle(const Key& key) {
    const std::string name(key.info.name);
    Origin& origin = config_.origins[name];
    const auto found = resolved_.find(name);
    if (found == resolved_.end()) {
      if (key.info.has(kRequired)) report_missing(key);
      return;
    }
    const TomlEntry& entry = found->second.entry;
    origin = found->second.origin;
    if (!entry.value) return;
    if (!assign(key, *entry.value, entry.value_place, problems_)) {
      if (!found->second.word.empty())
        problems_.back().notes.push_back("`" + found->second.word + "` of data sheets is the key `" + name +
                                         "`");
      return;
    }
    check_interval(key, entry, origin);
  }

  void report_missing(const Key& key) {
    Diagnostic d;
    d.code = "C015";
    d.message = "missing key `" + std::string(key.info.name) + "` in gpu \"" + config_.id + "\"";
    d.place.file = base_path_;
    d.notes.push_back(std::string(key.info.name) + ": " + std::string(key.info.description));
    d.help = "add `" + std::string(key.info.name) + " = ...`, or extend a GPU that has it; " +
             std::string(kSchemaHelp);
    problems_.push_back(std::move(d));
  }

  void check_interval(const Key& key, const TomlEntry& entry, const Origin& origin) {
    const auto* number = std::get_if<double*>(&key.slot);
    if (!origin.interval || !number) return;
    if ((*origin.interval)[0] <= **number && **number <= (*origin.interval)[1]) return;
    Diagnostic d;
    d.code = "C022";
    d.message = "`" + entry.path + "` is " + to_toml(**number) + ", outside its own interval [" +
                to_toml((*origin.interval)[0]) + ", " + to_toml((*origin.interval)[1]) + "]";
    d.place = entry.value_place;
    d.help = "widen the interval, or leave it out";
    problems_.push_back(std::move(d));
  }

  std::string config_dir_, preferred_dir_;
  std::string base_path_;
  GpuConfig config_;
  std::vector<Key> keys_;  ///< slots point into config_
  std::map<std::string, Resolved, std::less<>> resolved_;
  std::vector<Diagnostic> problems_;
  bool base_missing_ = false;  ///< then missing keys would only repeat the first cause
};

std::vector<std::string> list_gpus(const std::string& config_dir) {
  std::vector<std::string> ids;
  std::error_code error;
  for (const auto& file : fs::directory_iterator(config_dir, error))
    if (file.path().extension() == ".toml") ids.push_back(file.path().stem().string());
  std::sort(ids.begin(), ids.end());
  return ids;
}

namespace {

/// Lays settings over a GPU as Loader::set does, without resolving its other keys anew. False where something
/// is wrong: the loader, which knows what every layer said, finds the words.
bool lay_over(GpuConfig& gpu, std::span<const Assignment> sets) {
  std::vector<Diagnostic> problems;
  const std::vector<Key> keys = keys_of(gpu);
  for (const Assignment& set : sets) {
    if (set.group() != "gpu") continue;
    std::string_view name = std::string_view(set.path).substr(set.path.find('.') + 1);
    if (const SheetWord* word = find_sheet_word(name); word && word->factor == 1.0) name = word->key;
    const Key* key = find_key(keys, name);
    std::optional<TomlValue> value = value_of_assignment(set, problems);
    if (!key || !value) return false;
    if (const auto factor = scale_factor(*key, *value)) value = scaled(value_in(key->slot), *factor);
    if (!assign(*key, *value, {}, problems)) return false;
    Origin& origin = gpu.origins[std::string(key->info.name)];
    origin = Origin{};
    origin.layer = Origin::Layer::command_line;
  }
  check_rules(gpu, problems);
  return problems.empty();
}

}  // namespace

GpuFiles::GpuFiles(const std::string& id_or_path, std::span<const std::string> overlays,
                   const std::string& config_dir, const std::string& preferred_dir) {
  auto loader = std::make_shared<Loader>(config_dir, preferred_dir);
  loader->base(id_or_path);
  for (const std::string& path : overlays) loader->overlay(path);
  read_ = std::move(loader);
  try {
    plain_ = std::make_shared<const GpuConfig>(Loader(*read_).finish());
  } catch (const InputError&) {  // told by `with`, which knows the settings too: they may mend it
    plain_ = nullptr;
  }
}

GpuConfig GpuFiles::with(std::span<const Assignment> sets) const {
  if (plain_) {
    GpuConfig gpu = *plain_;
    if (lay_over(gpu, sets)) return gpu;
  }
  Loader loader = *read_;
  for (const Assignment& assignment : sets) loader.set(assignment);
  return loader.finish();
}

GpuConfig load_gpu(const std::string& id_or_path, std::span<const std::string> overlays,
                   std::span<const Assignment> sets, const std::string& config_dir) {
  return GpuFiles(id_or_path, overlays, config_dir).with(sets);
}

}  // namespace hwsim
