#pragma once
// Options of techniques: a plain struct a technique, and one declaration for each of its fields, from which
// parsing, texts, lists and messages follow.
#include <any>
#include <array>
#include <functional>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace hwsim::algos {

/// What users are told of an option. Values are numbers; the value of a named choice is its index.
struct OptionInfo {
  std::string_view name;
  std::string_view description;
  double default_value = 0.0, min = 0.0, max = 0.0;
  std::string_view choices = "";  ///< "stencil|compute"; empty for numbers
  bool whole = false;             ///< a number without a fraction
};

/// An option tied to its field in one struct.
struct BoundOption {
  OptionInfo info;  ///< without the default
  std::function<double()> get;
  std::function<void(double)> set;
};

/// The options of a struct O in the order in which users see them. O has a function describe(OptionList&, O&)
/// beside it, which declares each field with one call.
class OptionList {
 public:
  void real(std::string_view name, double& field, std::array<double, 2> range, std::string_view description);
  void whole(std::string_view name, int& field, std::array<int, 2> range, std::string_view description);
  /// A number that the technique's name says already: no other value is allowed.
  void fixed(std::string_view name, int& field, std::string_view description);
  /// The names of the field's values, "off|on", in the order of its enumerators, or of false and true.
  template <class Field>
  void choice(std::string_view name, Field& field, std::string_view choices, std::string_view description) {
    static_assert(std::is_enum_v<Field> || std::is_same_v<Field, bool>);
    add(
        {name, description, 0.0, 0.0, 0.0, choices}, [&field] { return static_cast<double>(field); },
        [&field](double value) { field = static_cast<Field>(static_cast<int>(value)); });
  }
  /// The same for a number: the values that the names stand for.
  template <std::size_t kCount>
  void choice(std::string_view name, int& field, std::string_view choices,
              const std::array<int, kCount>& values, std::string_view description) {
    const auto index = [&field, values] {
      double i = 0.0;
      for (const int value : values) {
        if (value == field) break;
        ++i;
      }
      return i;
    };
    add({name, description, 0.0, 0.0, 0.0, choices}, index,
        [&field, values](double i) { field = values.at(static_cast<std::size_t>(i)); });
  }

  std::vector<BoundOption> take() { return std::move(options_); }

 private:
  void add(const OptionInfo& info, std::function<double()> get, std::function<void(double)> set);

  std::vector<BoundOption> options_;
};

/// The options of a technique that has none.
struct NoOptions {};
inline void describe(OptionList&, NoOptions&) {}

/// A technique's options: a value of its struct, behind a face that all techniques share.
class Options {
 public:
  template <class Struct>
  explicit Options(Struct values)
      : values_(std::move(values)), bind_([](std::any& any) {
          OptionList list;
          describe(list, *std::any_cast<Struct>(&any));
          return list.take();
        }) {}

  /// The struct that it was made from.
  template <class Struct>
  const Struct& as() const {
    return std::any_cast<const Struct&>(values_);
  }

  /// Tied to this object, as long as it is neither copied to nor moved.
  std::vector<BoundOption> bound() { return bind_(values_); }

  /// The declarations, with this object's values as defaults.
  std::vector<OptionInfo> infos() const;

 private:
  std::any values_;
  std::vector<BoundOption> (*bind_)(std::any& values);
};

}  // namespace hwsim::algos
