// Chains, words and registers of shaders small enough to count by hand.
#include "pipeline/shade/op_recorder.h"

#include <gtest/gtest.h>

#include "pipeline/shade/count_fragment-inl.h"

namespace hwsim::pipeline {
namespace {
using HWY_NAMESPACE::CountFragment;

TEST(OpRecorder, AFusedMultiplyAddIsOneStepOfTheChain) {
  CountFragment s;
  const CountF x = s.attr(0), y = s.attr(1);
  const CountF z = (x * y + x) * y + x;  // two multiply-adds, one after the other
  s.output(0, {z, z, z, z});
  const ShaderOps ops = s.blocks()[0];
  EXPECT_EQ(ops.alu, 2u);
  EXPECT_EQ(ops.interp, 2u);
  EXPECT_EQ(ops.alu_chain, 3u);  // interpolate, fma, fma
  EXPECT_EQ(ops.vliw5_words, 2u);
}

TEST(OpRecorder, TheAddendsChainGoesThroughTheAddition) {
  CountFragment s;
  const CountF x = s.attr(0);
  CountF sum = x;
  for (int i = 0; i < 4; ++i) sum = x * x + sum;  // independent products, one after the other only in the sum
  s.output(0, {sum, sum, sum, sum});
  EXPECT_EQ(s.blocks()[0].alu, 4u);
  EXPECT_EQ(s.blocks()[0].alu_chain, 1u + 4u);  // interpolate; each addition issues with its product, in turn
}

TEST(OpRecorder, IndependentOperationsFillWordsAndSpecialFunctionsTakeTheirOneSlot) {
  CountFragment wide;
  const CountF x = wide.attr(0);
  CountF last;
  for (int i = 0; i < 10; ++i) last = min(x, x);
  EXPECT_EQ(wide.blocks()[0].vliw5_words, 2u);
  CountFragment special;
  const CountF y = special.attr(0);
  for (int i = 0; i < 10; ++i) last = rsqrt(y);
  EXPECT_EQ(special.blocks()[0].vliw5_words, 10u);
}

TEST(OpRecorder, DependentTextureReadsAreAChainAndOthersAreNot) {
  CountFragment s;
  const auto a = s.load_image(0, s.pixel_x(), s.pixel_y(), CountI(0));
  const auto b = s.load_image(1, s.pixel_x(), s.pixel_y(), CountI(0));
  const auto c = s.load_image(0, to_int(a.x), to_int(b.x), CountI(0));
  s.output(0, c);
  EXPECT_EQ(s.blocks()[0].memory_chain, 2u);
  EXPECT_EQ(s.blocks()[0].load, 0u);  // image reads are the texture unit's
}

TEST(OpRecorder, RegistersHoldWhatIsStillToBeUsed) {
  const auto registers = [](int values) {
    CountFragment s;
    std::vector<CountF> kept;
    const CountF x = s.attr(0);
    for (int i = 0; i < values; ++i) kept.push_back(min(x, x));
    CountF sum = kept[0];  // uses them from the first to the last
    for (int i = 1; i < values; ++i) sum = max(sum, kept[static_cast<std::size_t>(i)]);
    s.output(0, {sum, sum, sum, sum});
    return s.blocks()[0].registers;
  };
  // Each value is made just before it is used: the sum, the value, its source.
  EXPECT_EQ(registers(3), registers(20));
  CountFragment reversed;
  std::vector<CountF> chain = {reversed.attr(0)};
  for (int i = 0; i < 9; ++i) chain.push_back(min(chain.back(), chain.back()));
  CountF sum = chain.back();  // the last of the chain first: all of them have to be kept
  for (int i = 8; i >= 0; --i) sum = max(sum, chain[static_cast<std::size_t>(i)]);
  reversed.output(0, {sum, sum, sum, sum});
  EXPECT_GE(reversed.blocks()[0].registers, 9u + 1u);
}

TEST(OpRecorder, BlocksHaveChainsOfTheirOwn) {
  CountFragment s;
  const CountF x = min(s.attr(0), s.attr(0));
  s.branch(1, x < x, [&]() { s.output(0, {max(x, x), x, x, x}); });
  const BlockOps blocks = s.blocks();
  EXPECT_EQ(blocks[0].alu_chain, 3u);  // interpolate, min, compare
  EXPECT_EQ(blocks[1].alu_chain, 1u);  // max alone: x was there
  EXPECT_EQ(blocks[1].alu, 2u);        // and the branch
}

// A function called at two places brings its block to both. Lanes are counted at each, so the block costs
// what it does at one.
TEST(OpRecorder, ABlockAtTwoPlacesCostsWhatItDoesAtTheDearest) {
  CountFragment s;
  const CountF x = s.attr(0);
  CountF sum = x;
  const auto light = [&](int steps) {
    s.branch(2, x < x, [&]() {
      for (int i = 0; i < steps; ++i) sum = sum + x;
      s.branch(3, x < x, [&]() { sum = rsqrt(sum); });
    });
  };
  light(3);
  light(5);
  light(4);
  s.output(0, {sum, sum, sum, sum});
  const BlockOps blocks = s.blocks();
  EXPECT_EQ(blocks[2].alu, 5u + 1u + 1u);  // additions, the inner comparison, the branch
  EXPECT_EQ(blocks[2].alu_chain, 5u);  // not the 12 of all three, though each goes on with the last one's sum
  EXPECT_EQ(blocks[3].sfu, 1u);
  EXPECT_EQ(blocks[3].alu, 1u);
  EXPECT_EQ(blocks[0].alu, 3u);  // the outer comparisons
}

TEST(OpRecorder, ABlockInsideItselfAddsUp) {
  CountFragment s;
  const CountF x = s.attr(0);
  s.branch(1, x < x, [&]() { s.branch(1, x < x, [&]() { s.output(0, {x + x, x, x, x}); }); });
  EXPECT_EQ(s.blocks()[1].alu, 1u + 1u + 1u + 1u);  // two branches, a comparison, an addition
}

}  // namespace
}  // namespace hwsim::pipeline
