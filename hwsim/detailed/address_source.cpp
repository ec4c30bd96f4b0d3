#include "hwsim/detailed/address_source.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace hwsim {
namespace {

constexpr std::size_t kWordBits = 64;

/// The position of the rank-th bit that is set.
std::size_t select_bit(std::uint64_t word, std::size_t rank) {
  std::size_t position = 0;
  for (int half = 32; half > 0; half /= 2) {
    const auto low = static_cast<std::size_t>(std::popcount(word & ((std::uint64_t{1} << half) - 1)));
    if (rank < low) continue;
    rank -= low;
    word >>= half;
    position += static_cast<std::size_t>(half);
  }
  return position;
}

}  // namespace

LruStack::LruStack(std::size_t lines_max)
    : lines_max_(std::max<std::size_t>(lines_max, 16)),
      lines_(std::max(kWordBits, std::bit_ceil(2 * lines_max_))),
      present_(lines_.size() / kWordBits, 0),
      sums_(present_.size() + 1, 0) {}

void LruStack::set(std::size_t position, bool present) {
  const std::size_t word = position / kWordBits;
  present_[word] ^= std::uint64_t{1} << position % kWordBits;
  const std::int32_t change = present ? 1 : -1;
  for (std::size_t i = word + 1; i < sums_.size(); i += i & (~i + 1)) sums_[i] += change;
}

std::size_t LruStack::place_of(std::size_t rank) const {
  std::size_t word = 0;
  auto rest = static_cast<std::int32_t>(rank);
  for (std::size_t step = present_.size(); step > 0; step /= 2)
    if (word + step < sums_.size() && sums_[word + step] <= rest) {
      word += step;
      rest -= sums_[word];
    }
  return word * kWordBits + select_bit(present_[word], static_cast<std::size_t>(rest));
}

void LruStack::append(std::uint64_t line) {
  if (end_ == lines_.size()) compact();
  lines_[end_] = line;
  set(end_++, true);
  ++count_;
}

bool LruStack::push(std::uint64_t line) {
  const bool full = count_ == lines_max_;
  if (full) {
    set(place_of(0), false);
    --count_;
  }
  append(line);
  return full;
}

std::uint64_t LruStack::reuse(std::size_t rank) {
  const std::size_t place = place_of(rank);
  const std::uint64_t line = lines_[place];
  if (rank + 1 == count_) return line;
  set(place, false);
  --count_;
  append(line);
  return line;
}

void LruStack::compact() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < end_; ++i)
    if ((present_[i / kWordBits] >> i % kWordBits & 1) != 0) lines_[kept++] = lines_[i];
  end_ = 0;
  std::fill(present_.begin(), present_.end(), 0);
  std::fill(sums_.begin(), sums_.end(), 0);
  while (end_ < kept) set(end_++, true);
}

Survival survival(const std::array<std::uint64_t, kCacheSizes>& bytes, std::uint64_t requested,
                  double reached) {
  Survival part;
  double size = kSmallestCacheBytes;
  for (std::size_t k = 0; k < part.size(); ++k, size *= 2.0) {
    const double beyond = moved_ratio(bytes, requested, size);
    part[k] = reached <= 0.0 ? 1.0 : std::min(1.0, beyond / reached);
  }
  return part;
}

double missing(const Survival& survival, double lines) {
  double size = kSmallestCacheBytes / 64.0, below = 0.0, beyond = 1.0;  // a cache of no lines has nothing
  for (const double part : survival) {
    if (lines < size) return beyond + (part - beyond) * (lines - below) / (size - below);
    beyond = part;
    below = size;
    size *= 2.0;
  }
  return beyond;
}

void AddressSource::start(Run& run, const Survival& survival, double nearest_lines) {
  const double u = random_.ratio() * missing(survival, nearest_lines);
  std::size_t k = 0;
  while (k < survival.size() && u < survival[k]) ++k;
  run.fresh = true;
  if (k == survival.size()) return;
  // Within a doubling: where the survival, taken as linear in the size, has the value u.
  const double high = kSmallestCacheBytes * std::ldexp(1.0, static_cast<int>(k)),
               low = k == 0 ? 0.0 : high / 2.0;
  const double above = k == 0 ? 1.0 : survival[k - 1];
  const double part = above > survival[k] ? (above - u) / (above - survival[k]) : 1.0;
  const auto depth = static_cast<std::size_t>((low + part * (high - low)) / 64.0);
  if (depth >= stack_.size()) return;
  run.fresh = false;
  run.rank = stack_.size() - 1 - depth;
}

/// Lines above one that is taken away move down.
void AddressSource::taken(std::size_t rank) {
  for (Run& run : runs_)
    if (rank < run.rank) --run.rank;
}

std::uint64_t AddressSource::fresh() {
  if (stack_.push(next_)) taken(0);
  return next_++;
}

std::uint64_t AddressSource::next(const Survival& survival, bool write, double run_lines,
                                  double nearest_lines) {
  Run& run = runs_[write ? 1 : 0];
  if (run.left < 1.0) {
    run.left += run_lines;
    start(run, survival, nearest_lines);
  }
  run.left -= 1.0;
  if (run.fresh) return fresh();
  // The neighbor was used right after the line before it, so it has that one's rank now.
  const std::size_t rank = std::min(run.rank, stack_.size() - 1);
  const std::uint64_t line = stack_.reuse(rank);
  taken(rank);
  return line;
}

}  // namespace hwsim
