#include "pipeline/base/arena.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <vector>

namespace hwsim::pipeline {
namespace {

TEST(ArenaTest, PiecesLieApartAndAligned) {
  Arena arena;
  std::vector<std::uint64_t*> pieces;
  for (std::size_t i = 0; i < 300; ++i) {  // more than one block holds
    pieces.push_back(arena.take<std::uint64_t>(1000 + i));
    std::fill_n(pieces.back(), 1000 + i, i);
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(pieces[i]) % 16, 0u);
    EXPECT_EQ(std::accumulate(pieces[i], pieces[i] + 1000 + i, std::uint64_t{0}), i * (1000 + i));
  }
}

TEST(ArenaTest, WhatIsClearedIsTakenAgain) {
  Arena arena;
  const auto* first = arena.take<char>(100);
  arena.take<char>(std::size_t{3} << 20);
  arena.clear(SIZE_MAX);
  EXPECT_EQ(arena.take<char>(200), first);
  EXPECT_NE(arena.take<char>(std::size_t{3} << 20), nullptr);
}

TEST(ArenaTest, KeepsNoMoreThanItIsTold) {
  Arena arena;
  for (int i = 0; i < 8; ++i) arena.take<char>(std::size_t{1} << 20);
  EXPECT_EQ(arena.held_bytes(), std::size_t{8} << 20);
  arena.clear(std::size_t{2} << 20);
  EXPECT_EQ(arena.held_bytes(), std::size_t{2} << 20);
}

}  // namespace
}  // namespace hwsim::pipeline
