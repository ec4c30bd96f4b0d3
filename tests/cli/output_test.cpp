// Standard output: what cannot be written is an error, what nobody reads is none.
#include <gtest/gtest.h>

#include "cli/program.h"

namespace hwsim::cli::test {
namespace {

TEST(Output, FullDeviceIsAnErrorOfEveryCommandThatPrints) {
  const Workplace place;
  for (const std::string arguments : {"list gpus", "list gpus --json", "config show gtx980", "config schema",
                                      "help U021", "help run", "completion bash", "--help", "--version"}) {
    const Outcome outcome = place.shell("hwsim " + arguments + " > /dev/full");
    EXPECT_EQ(outcome.status, 1) << arguments;
    EXPECT_NE(outcome.err.find("error[U010]"), std::string::npos) << arguments << outcome.err;
    EXPECT_NE(outcome.err.find("= help:"), std::string::npos) << arguments << outcome.err;
  }
}

TEST(Output, ClosedStreamIsAnError) {
  const Workplace place;
  const Outcome outcome = place.shell("hwsim list gpus >&-");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("error[U010]"), std::string::npos) << outcome.err;
}

TEST(Output, ReaderThatHasEnoughEndsTheProgramQuietly) {
  const Workplace place;
  // The reader is gone before the first byte is written.
  const Outcome outcome = place.shell("{ sleep 0.2; hwsim list gpus; echo status $? >&2; } | true");
  EXPECT_EQ(outcome.err, "status 0\n");
}

}  // namespace
}  // namespace hwsim::cli::test
