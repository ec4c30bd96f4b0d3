#pragma once
// Coverage at more positions than a pixel has samples (CSAA, EQAA;
// docs/techniques/forward.md#coverage-sampling). The first positions are those of the samples, with depth and
// color of their own; every further one names the sample whose color it has, or none. The rule is ours, no
// vendor documents one.
//
// A fragment that passes the depth test at some sample takes, in the name of the lowest of these samples, the
// further positions that it covers, where it wins against the depth of the sample that they name. Positions
// that named an overwritten sample and that the fragment does not cover are orphans: they follow their
// fragment to another sample that it still holds (the samples' own entries say which belong together), and
// name none where it holds none. `drop_orphans`: they name none at once, as
// docs/techniques/forward.md#coverage-sampling has it; along a silhouette the later of two surfaces then
// weighs too much, for the earlier one loses positions.
//
// A fragment without any sample has no color here; positions where it wins name none. They stand for what the
// nearest sample shows, in the depth test and in the resolve: most such fragments are small triangles of a
// surface that other triangles bring to that sample. Left out of the resolve, and open to whatever is drawn
// later behind them, they made silhouettes of fine meshes too thin (dragon at 4 of 16: 43.8 dB, 45.7 so).
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace hwsim::pipeline {

inline constexpr int kMaxCoveragePositions = 32;  ///< each has four bits in a map's words
inline constexpr int kCoverageWordPositions = 16;
inline constexpr std::uint32_t kNoSample = 15;

/// 64-bit words of a pixel's map in memory.
constexpr std::size_t coverage_words(int positions) { return positions > kCoverageWordPositions ? 2 : 1; }

/// The entries of a pixel. Those of samples name the lowest sample of the same fragment. All zero: one
/// fragment covers the pixel everywhere.
class CoverageWord {
 public:
  CoverageWord() = default;
  CoverageWord(const std::uint64_t* words, std::size_t count)
      : words_{words[0], count > 1 ? words[1] : std::uint64_t{0}} {}
  void store(std::uint64_t* words, std::size_t count) const {
    for (std::size_t i = 0; i < count; ++i) words[i] = words_[i];
  }
  std::uint32_t at(int position) const {
    return static_cast<std::uint32_t>(words_[word_of(position)] >> shift_of(position)) & 15u;
  }
  void set(int position, std::uint32_t sample) {
    std::uint64_t& word = words_[word_of(position)];
    const int shift = shift_of(position);
    word = (word & ~(std::uint64_t{15} << shift)) | std::uint64_t{sample} << shift;
  }
  friend bool operator==(const CoverageWord&, const CoverageWord&) = default;

 private:
  static std::size_t word_of(int position) {
    return static_cast<std::size_t>(position / kCoverageWordPositions);
  }
  static int shift_of(int position) { return 4 * (position % kCoverageWordPositions); }

  std::array<std::uint64_t, 2> words_{};
};

/// What the rules need to know of an image's positions; the first `samples` of them are the samples'.
struct CoverageLayout {
  int samples = 0, positions = 0;
  std::array<std::uint8_t, kMaxCoveragePositions> nearest_sample{};  ///< the first of those equally near

  /// The sample that a position stands for.
  std::uint32_t shown_at(const CoverageWord& map, int position) const {
    const std::uint32_t named = map.at(position);
    return named == kNoSample ? nearest_sample[static_cast<std::size_t>(position)] : named;
  }
};
/// The layout for a pattern that coverage_positions() knows. Throws as that does.
const CoverageLayout& coverage_layout(int samples, int positions);

/// Another sample of the fragment of `sample` among those of `left`, or none.
inline std::uint32_t sample_of_same(const CoverageWord& map, std::uint32_t sample, std::uint32_t left) {
  for (std::uint32_t rest = left; rest != 0; rest &= rest - 1) {
    const int k = std::countr_zero(rest);
    if (map.at(k) == sample) return static_cast<std::uint32_t>(k);
  }
  return kNoSample;
}

/// The map of a pixel after a fragment with the samples `passed` (one or more) and the positions `covered`.
/// wins(position, sample): whether the fragment at the position lies in front of what the sample holds.
template <class Wins>
CoverageWord insert_fragment(CoverageWord map, const CoverageLayout& layout, std::uint32_t passed,
                             std::uint32_t covered, bool drop_orphans, Wins&& wins) {
  const CoverageWord before = map;
  const std::uint32_t left = ~passed & ((1u << layout.samples) - 1);
  const auto own = static_cast<std::uint32_t>(std::countr_zero(passed));
  const auto is_passed = [&](std::uint32_t s) { return s != kNoSample && (passed >> s & 1u) != 0; };
  for (int k = 0; k < layout.samples; ++k) {
    const std::uint32_t named = before.at(k);
    if (is_passed(static_cast<std::uint32_t>(k)))
      map.set(k, own);
    else if (is_passed(named))
      map.set(k, sample_of_same(before, named, left));
  }
  for (int q = layout.samples; q < layout.positions; ++q) {
    const std::uint32_t named = before.at(q), shown = layout.shown_at(before, q);
    if ((covered >> q & 1u) == 0) {
      if (is_passed(named)) map.set(q, drop_orphans ? kNoSample : sample_of_same(before, named, left));
    } else if (is_passed(shown) || wins(q, static_cast<int>(shown))) {
      map.set(q, own);
    }
  }
  return map;
}

/// The map after a fragment that covers further positions alone.
template <class Wins>
CoverageWord hide_positions(CoverageWord map, const CoverageLayout& layout, std::uint32_t covered,
                            Wins&& wins) {
  for (int q = layout.samples; q < layout.positions; ++q)
    if ((covered >> q & 1u) != 0 && map.at(q) != kNoSample && wins(q, static_cast<int>(map.at(q))))
      map.set(q, kNoSample);
  return map;
}

}  // namespace hwsim::pipeline
