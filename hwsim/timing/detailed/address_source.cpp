#include "hwsim/timing/detailed/address_source.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace hwsim {

LruStack::LruStack(std::size_t lines_max)
    : lines_max_(std::max<std::size_t>(lines_max, 16)),
      lines_(std::bit_ceil(2 * lines_max_)),
      present_(lines_.size(), false),
      sums_(lines_.size() + 1, 0) {}

void LruStack::add(std::size_t position, std::int32_t value) {
  for (std::size_t i = position + 1; i < sums_.size(); i += i & (~i + 1)) sums_[i] += value;
}

std::size_t LruStack::place_of(std::size_t rank) const {
  std::size_t position = 0;
  auto rest = static_cast<std::int32_t>(rank);
  for (std::size_t step = lines_.size(); step > 0; step /= 2)
    if (position + step < sums_.size() && sums_[position + step] <= rest) {
      position += step;
      rest -= sums_[position];
    }
  return position;
}

void LruStack::append(std::uint64_t line) {
  if (end_ == lines_.size()) compact();
  lines_[end_] = line;
  present_[end_] = true;
  add(end_++, 1);
  ++count_;
}

bool LruStack::push(std::uint64_t line) {
  const bool full = count_ == lines_max_;
  if (full) {
    const std::size_t oldest = place_of(0);
    present_[oldest] = false;
    add(oldest, -1);
    --count_;
  }
  append(line);
  return full;
}

std::uint64_t LruStack::reuse(std::size_t rank) {
  const std::size_t place = place_of(rank);
  const std::uint64_t line = lines_[place];
  if (rank + 1 == count_) return line;
  present_[place] = false;
  add(place, -1);
  --count_;
  append(line);
  return line;
}

void LruStack::compact() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < end_; ++i)
    if (present_[i]) lines_[kept++] = lines_[i];
  end_ = kept;
  std::fill(present_.begin(), present_.end(), false);
  std::fill(sums_.begin(), sums_.end(), 0);
  for (std::size_t i = 0; i < kept; ++i) {
    present_[i] = true;
    add(i, 1);
  }
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
