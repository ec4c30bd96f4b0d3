#include "hwsim/trace/trace_file.h"

#include <array>
#include <concepts>
#include <limits>
#include <type_traits>
#include <utility>

#include "hwsim/base/byte_codec.h"
#include "hwsim/base/content_hash.h"
#include "hwsim/trace/trace_fields.h"

namespace hwsim {
namespace {

constexpr std::string_view kKind = "hwtrace";
constexpr std::string_view kEncoding =
    "columns of zigzag differences, 1";  // raised when the code below changes

constexpr PassKind last_value(PassKind) { return PassKind::resolve; }
constexpr Format last_value(Format) { return kLastFormat; }
std::string_view value_name(PassKind kind) { return pass_kind_name(kind); }
std::string_view value_name(Format format) { return info(format).name; }

template <class T>
concept Whole = std::integral<T>;
template <class T>
concept Enumerated = std::is_enum_v<T>;

class Layout {
 public:
  template <class T>
  void field(std::string_view name, const T& value) {
    text_ += std::string(name) + ":";
    add(value);
    text_ += ";";
  }
  std::string take() { return std::move(text_); }

 private:
  template <Whole T>
  void add(const T&) {
    text_ += (std::is_signed_v<T> ? "i" : "u") + std::to_string(8 * sizeof(T));
  }
  template <Enumerated T>
  void add(const T& value) {
    for (int i = 0; i <= static_cast<int>(last_value(value)); ++i)
      text_ += (i ? "|" : "") + std::string(value_name(static_cast<T>(i)));
  }
  void add(const double&) { text_ += "f64"; }
  void add(const std::string&) { text_ += "text"; }
  void add(const PassCounters&) {
    for (const CounterInfo& counter : counter_catalog()) text_ += std::string(counter.id) + ",";
  }
  template <class T>
  void add(const std::vector<T>&) {
    text_ += "[";
    add(T{});
    text_ += "]";
  }
  template <class T, std::size_t N>
  void add(const std::array<T, N>&) {
    text_ += std::to_string(N) + "*";
    add(T{});
  }
  template <class T>
  void add(const T& record) {
    text_ += "{";
    describe_fields(*this, record);
    text_ += "}";
  }
  std::string text_;
};

class Encoder {
 public:
  template <class T>
  void field(std::string_view, const T& value) {
    add(value);
  }
  std::vector<std::uint8_t> take() { return out_.take(); }

 private:
  template <Whole T>
  void add(const T& value) {
    if constexpr (std::is_signed_v<T>)
      out_.integer(value);
    else
      out_.count(value);
  }
  template <Enumerated T>
  void add(const T& value) {
    out_.count(static_cast<std::uint64_t>(value));
  }
  void add(const double& value) { out_.real(value); }
  void add(const std::string& value) { out_.text(value); }
  /// Counter by counter: neighbors resemble each other, and a counter that the pass does not use takes a
  /// byte. The first column is always written, so that the number of chunks is bounded by the bytes of the
  /// file.
  void add(const std::vector<PassCounters>& chunks) {
    out_.count(chunks.size());
    for (std::size_t i = 0; i < kCounterCount; ++i) {
      bool used = i == 0;
      for (const PassCounters& chunk : chunks) used = used || values(chunk)[i] != 0;
      out_.count(used ? 1 : 0);
      std::uint64_t last = 0;
      for (std::size_t k = 0; used && k < chunks.size(); ++k) {
        const std::uint64_t value = values(chunks[k])[i];
        out_.integer(static_cast<std::int64_t>(value - last));
        last = value;
      }
    }
  }
  template <class T>
  void add(const std::vector<T>& list) {
    out_.count(list.size());
    for (const T& value : list) add(value);
  }
  template <class T, std::size_t N>
  void add(const std::array<T, N>& list) {
    for (const T& value : list) add(value);
  }
  template <class T>
  void add(const T& record) {
    describe_fields(*this, record);
  }
  ByteWriter out_;
};

class Decoder {
 public:
  explicit Decoder(std::span<const std::uint8_t> bytes) : in_(bytes) {}
  template <class T>
  void field(std::string_view, T& value) {
    read(value);
  }
  void expect_end() const { in_.expect_end(); }

 private:
  template <Whole T>
  void read(T& value) {
    if constexpr (std::is_signed_v<T>)
      value = checked<T>(in_.integer());
    else
      value = checked<T>(in_.count());
  }
  template <class T, class Wide>
  static T checked(Wide wide) {
    if (wide < static_cast<Wide>(std::numeric_limits<T>::min()) ||
        wide > static_cast<Wide>(std::numeric_limits<T>::max()))
      throw DamagedBytes("a number is out of range");
    return static_cast<T>(wide);
  }
  template <Enumerated T>
  void read(T& value) {
    const std::uint64_t number = in_.count();
    if (number > static_cast<std::uint64_t>(last_value(value)))
      throw DamagedBytes("a value is none of those known");
    value = static_cast<T>(number);
  }
  void read(double& value) { value = in_.real(); }
  void read(std::string& value) { value = in_.text(); }
  void read(std::vector<PassCounters>& chunks) {
    chunks.resize(in_.elements());
    for (std::size_t i = 0; i < kCounterCount; ++i) {
      const bool used = in_.count() != 0;
      std::uint64_t last = 0;
      for (std::size_t k = 0; used && k < chunks.size(); ++k)
        values(chunks[k])[i] = last += static_cast<std::uint64_t>(in_.integer());
    }
  }
  template <class T>
  void read(std::vector<T>& list) {
    list.resize(in_.elements());
    for (T& value : list) read(value);
  }
  template <class T, std::size_t N>
  void read(std::array<T, N>& list) {
    for (T& value : list) read(value);
  }
  template <class T>
  void read(T& record) {
    describe_fields(*this, record);
  }
  ByteReader in_;
};

}  // namespace

std::string trace_layout() {
  Layout layout;
  layout.field(kEncoding, WorkTrace{});
  return layout.take();
}

std::uint64_t trace_version() {
  static const std::uint64_t version = [] {  // the text takes as long as reading a small trace
    const std::string layout = trace_layout();
    ContentHash hash;
    hash.add({reinterpret_cast<const std::uint8_t*>(layout.data()), layout.size()});
    return hash.words()[0];
  }();
  return version;
}

std::vector<std::uint8_t> encode_trace(const WorkTrace& trace) {
  Encoder encoder;
  encoder.field("trace", trace);
  return seal(kKind, trace_version(), encoder.take());
}

DecodedTrace decode_trace(std::span<const std::uint8_t> bytes) {
  DecodedTrace result;
  try {
    Decoder decoder(open_seal(kKind, trace_version(), bytes));
    decoder.field("trace", result.trace.emplace());
    decoder.expect_end();
  } catch (const DamagedBytes& damage) {
    result.trace.reset();
    result.damage = damage.what();
  }
  return result;
}

}  // namespace hwsim
