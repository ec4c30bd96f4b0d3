// The database of a sweep: any file, or a sweep into whose one point the input's values of any type are
// written. It is looked at, printed in every shape, and merged into another sweep.
#include <array>

#include "fuzz/fuzz_input.h"
#include "lab/studies/sweep_store.h"

namespace {
using namespace hwsim;

constexpr std::array kColumns = {
    "number",   "scene",    "technique", "gpu",     "engine",     "width_px",       "height_px",
    "settings", "run_file", "gpu_file",  "state",   "message",    "time_ms",        "lo_ms",
    "hi_ms",    "support",  "limiter",   "dram_mb", "memory_mib", "shaded_samples", "from_cache"};

/// Takes the input apart: a byte for the column, one for the type, then the value.
class Values {
 public:
  explicit Values(fuzz::Bytes input) : input_(input) {}
  bool more() const { return input_.size() > 2; }
  std::uint8_t byte() {
    const std::uint8_t value = input_.empty() ? std::uint8_t{0} : input_.front();
    input_ = input_.subspan(std::min<std::size_t>(1, input_.size()));
    return value;
  }
  std::uint64_t word() {
    std::uint64_t value = 0;
    for (int i = 0; i < 8; ++i) value = value << 8 | byte();
    return value;
  }
  std::string text() {
    const fuzz::Bytes taken = input_.first(std::min<std::size_t>(byte(), input_.size()));
    input_ = input_.subspan(taken.size());
    return std::string(fuzz::text_of(taken));
  }

 private:
  fuzz::Bytes input_;
};

/// A sweep without points, as every input finds it.
void empty_sweep(lab::Database& database) {
  database.execute("PRAGMA synchronous=OFF; PRAGMA journal_mode=MEMORY; DELETE FROM pass; DELETE FROM point");
}

void write_values(const std::string& path, fuzz::Bytes input) {
  Values values(input);
  lab::Database database(path, lab::Database::Mode::write);
  empty_sweep(database);
  database.execute(
      "INSERT INTO point (id, number, scene, technique, gpu, engine, width_px, height_px, settings, "
      "run_file, "
      "gpu_file, state) VALUES ('p', 1, 'grass', 'none', 'gtx980', 'queue', 64, 64, '{}', '', '', 'done')");
  while (values.more()) {
    const std::string column = kColumns.at(values.byte() % kColumns.size());
    const int type = values.byte() % 5;
    const std::string sql =
        "UPDATE OR IGNORE point SET " + column + (type == 4 ? " = CAST(? AS BLOB)" : " = ?");
    lab::Database::Statement update(database, sql);
    if (type == 0) update.bind_null(1);
    if (type == 1) update.bind(1, static_cast<std::int64_t>(values.word()));
    if (type == 2) update.bind(1, std::bit_cast<double>(values.word()));
    const std::string text = type > 2 ? values.text() : "";
    if (type > 2) update.bind(1, text);
    update.run();
  }
}

void look_at(const std::string& path) {
  const lab::RowSource rows = lab::sweep_rows(path);
  const auto take = [](std::string_view text) { fuzz::require(!text.empty(), "a piece of text is some"); };
  lab::write_csv(rows, take);
  lab::write_json(rows, take);
  lab::write_markdown(rows, take);
  std::string shown;
  lab::write_text(rows, [&](std::string_view text) { shown += text; });
  fuzz::require(printable(shown) == shown, "a table is safe for a terminal");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::ScratchFolder folder;
  static const std::string sweep = folder.file("sweep.db"), other = folder.file("other.db");
  static const bool made = [] {
    for (const std::string& path : {sweep, other}) lab::SweepStore(path, lab::SweepAccess::create);
    return true;
  }();
  const fuzz::Bytes input(data, size);
  const bool is_file = fuzz::text_of(input).starts_with("SQLite");
  const std::string path = is_file ? folder.write("any.db", input) : sweep;
  if (made && !is_file) write_values(path, input);
  fuzz::answer_or_refuse([&] { look_at(path); });
  {
    lab::Database database(other, lab::Database::Mode::write);
    empty_sweep(database);
  }
  fuzz::answer_or_refuse([&] {
    lab::SweepStore store(other, lab::SweepAccess::go_on);
    store.merge(path);
  });
  fuzz::answer_or_refuse([&] { look_at(other); });
  return 0;
}
