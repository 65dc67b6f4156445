// snapshot_commands_test.cpp - states kept, brought back and compared.
#include "tests/tools/debug/bench.hpp"
#include "tools/debug/commands.hpp"

namespace debug_console {
namespace {

using debug_test::Bench;
using testing::HasSubstr;
using testing::StartsWith;

TEST(SnapshotCommands, ARestoredRunRepeatsItselfExactly) {
    Bench bench;
    bench("tbreak wait");
    bench("c");
    EXPECT_THAT(bench("snapshot"), StartsWith("snapshot 1 at T "));
    bench("at +2ms send \"x\"");
    bench("snapshot armed");
    const std::string first = bench("until +20ms");
    const host_sim::BoardState end = bench.session.board.state;
    bench("restore armed");
    EXPECT_EQ(bench("where"),
              "#0  0130H print+3\n"
              "#1  012DH print called from 0126H main+38\n")
        << "the frames come back, too";
    EXPECT_EQ(bench("until +20ms"), first);
    EXPECT_TRUE(bench.session.board.state == end);
    EXPECT_THAT(first, HasSubstr(": \"OK\\n\"\n"));
}

TEST(SnapshotCommands, NamesAreNumbersWhenNotGiven) {
    Bench bench;
    EXPECT_EQ(bench("restore"), "refused: no snapshot yet; `snapshot` takes one");
    EXPECT_EQ(bench("snapshots"), "no snapshots\n");
    EXPECT_EQ(bench("snapshot"), "snapshot 1 at T 0 (0.000 ms)\n");
    bench("step");
    EXPECT_EQ(bench("snapshot"), "snapshot 2 at T 10 (0.003 ms)\n");
    EXPECT_EQ(bench("snapshot before"), "snapshot before at T 10 (0.003 ms)\n");
    EXPECT_EQ(bench("snapshots"),
              "1: T 0 (0.000 ms), PC 0000H\n"
              "2: T 10 (0.003 ms), PC 0100H main\n"
              "before: T 10 (0.003 ms), PC 0100H main\n");
    bench("restore 1");
    EXPECT_EQ(bench.t(), 0u);
    EXPECT_EQ(bench("restore 9"), "refused: 9: no such snapshot; `snapshots` lists them");
}

TEST(SnapshotCommands, DiffListsWhatIsDifferent) {
    Bench bench;
    bench("snapshot");
    EXPECT_EQ(bench("diff"), "no difference\n");
    bench("step 3");
    bench("poke 9000H 1 2");
    bench("poke 9003H 5");
    EXPECT_EQ(bench("diff"),
              "A: 00H -> 34H\n"
              "PC: 0000H -> 0105H\n"
              "T: 0 -> 27, +27\n"
              "N: 0 -> 3, +3\n"
              "memory 9000H count+4096: 2 bytes\n"
              "memory 9003H count+4099: 00H -> 05H\n");
    bench("step");
    EXPECT_THAT(bench("diff"), HasSubstr("timer-a counter 0: "));
    bench("trap bumper on");
    EXPECT_THAT(bench("diff 1"), HasSubstr("bumper: 0 -> 1\n"));
    for (int i = 0; i < 12; ++i) bench("poke " + std::to_string(0xA000 + 2 * i) + " 1");
    EXPECT_THAT(bench("diff 1"), HasSubstr("memory: 6 more places\n"));
}

}  // namespace
}  // namespace debug_console
