#pragma once
// What a program is handed beside its batch, and a digest that tells equal ones.
#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "hwsim/base/content_hash.h"

namespace hwsim::pipeline {

/// A digest of values. A struct takes part by a function `add_content(ContentDigest&, const T&)` beside it,
/// which names all its members by a structured binding, so that a new one that is forgotten does not compile;
/// one without padding and floats by its bytes.
class ContentDigest {
 public:
  using Words = std::array<std::uint64_t, 2>;

  template <class... T>
  void add(const T&... values) {
    (add_one(values), ...);
  }
  Words words() const {
    ContentHash hash;
    hash.add(std::span(reinterpret_cast<const std::uint8_t*>(values_.data()), 8 * values_.size()));
    return hash.words();
  }

 private:
  template <class T>
  static constexpr bool kIsPlain = std::is_arithmetic_v<T> || std::is_enum_v<T> || std::is_pointer_v<T>;

  template <class T>
  void add_one(const T& value) {
    if constexpr (kIsPlain<T>)
      add_plain(value);
    else if constexpr (std::has_unique_object_representations_v<T>)
      add_bytes(std::span(reinterpret_cast<const std::uint8_t*>(&value), sizeof value));
    else
      add_content(*this, value);
  }
  void add_bytes(std::span<const std::uint8_t> bytes) {
    for (std::size_t at = 0; at < bytes.size(); at += sizeof(std::uint64_t)) {
      std::uint64_t word = 0;
      __builtin_memcpy(&word, bytes.data() + at, std::min(sizeof word, bytes.size() - at));
      values_.push_back(word);
    }
  }
  template <class T>
  void add_plain(const T& value) {
    std::uint64_t word = 0;
    static_assert(sizeof(T) <= sizeof word);
    __builtin_memcpy(&word, &value, sizeof value);
    values_.push_back(word);
  }
  template <class T, std::size_t N>
  void add_one(const std::array<T, N>& values) {
    for (const T& value : values) add_one(value);
  }
  template <class T>
  void add_one(const std::vector<T>& values) {
    add_one(values.size());
    for (const T& value : values) add_one(value);
  }
  template <glm::length_t N, class T, glm::qualifier Q>
  void add_one(const glm::vec<N, T, Q>& value) {
    for (glm::length_t i = 0; i < N; ++i) add_one(value[i]);
  }
  template <glm::length_t C, glm::length_t R, class T, glm::qualifier Q>
  void add_one(const glm::mat<C, R, T, Q>& value) {
    for (glm::length_t i = 0; i < C; ++i) add_one(value[i]);
  }

  std::vector<std::uint64_t> values_;
};

template <class T>
concept HasContent = requires(ContentDigest& digest, const T& value) {
  add_content(digest, value);
};

/// Uniforms of any type.
class Uniforms {
 public:
  Uniforms() = default;
  Uniforms(std::nullptr_t /*none*/) {}  // NOLINT
  template <class T>
  Uniforms(std::shared_ptr<T> data)
      : data_(std::move(data)), add_(adder<std::remove_const_t<T>>()) {}  // NOLINT

  const void* get() const { return data_.get(); }
  explicit operator bool() const { return data_ != nullptr; }

  /// False where nothing tells equal ones: their type has no `add_content`.
  bool add_to(ContentDigest& digest) const {
    digest.add(reinterpret_cast<std::uintptr_t>(add_));
    if (!data_) return true;
    if (add_ == nullptr) return false;
    add_(digest, data_.get());
    return true;
  }

 private:
  using Adder = void (*)(ContentDigest&, const void*);
  template <class T>
  static Adder adder() {
    if constexpr (std::is_void_v<T>)
      return nullptr;
    else if constexpr (std::is_empty_v<T>)
      return [](ContentDigest&, const void*) {};
    else if constexpr (HasContent<T>)
      return [](ContentDigest& digest, const void* value) {
        add_content(digest, *static_cast<const T*>(value));
      };
    else
      return nullptr;
  }

  std::shared_ptr<const void> data_;
  Adder add_ = nullptr;
};

}  // namespace hwsim::pipeline
