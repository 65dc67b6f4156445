// Places of arguments and results: the table of docs/spec/abi.md.
#include "toolchain/codegen/abi.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using namespace toolchain::codegen;

/// "HL A m0": of each value its registers, high one first, or its offset in memory.
std::string shown(const ValuePlaces& places) {
    const std::string letters = "BCDEHLFA";
    std::string text;
    for (const ValuePlace& place : places.values) {
        if (!text.empty()) text += ' ';
        for (std::size_t i = place.registers.size(); i-- > 0;) {
            text += letters[static_cast<std::size_t>(place.registers[i])];
        }
        if (place.registers.empty()) text += fmt::format("m{}", place.offset);
    }
    return text;
}

std::string arguments(const std::vector<std::size_t>& sizes, bool through_pointer = false) {
    return shown(place_arguments(sizes, through_pointer));
}

TEST(Abi, WordsTakeHlDeBc) {
    EXPECT_EQ(arguments({2}), "HL");
    EXPECT_EQ(arguments({2, 2}), "HL DE");
    EXPECT_EQ(arguments({2, 2, 2}), "HL DE BC");
    EXPECT_EQ(arguments({2, 2, 2, 2}), "HL DE BC m0");
}

TEST(Abi, BytesTakeAThenHalvesOfPairs) {
    EXPECT_EQ(arguments({1}), "A");
    EXPECT_EQ(arguments({1, 1, 1, 1, 1, 1, 1, 1}), "A C B E D L H m0");
    EXPECT_EQ(arguments({2, 1, 2}), "HL A DE");
    // A pair of which a byte has one half is not free for a word.
    EXPECT_EQ(arguments({1, 1, 2, 2, 2}), "A C HL DE m0");
}

TEST(Abi, LongerValuesTakeTwoPairsOrAPairAndAByte) {
    EXPECT_EQ(arguments({4}), "DEHL");
    EXPECT_EQ(arguments({3}), "AHL");
    EXPECT_EQ(arguments({2, 4}), "HL BCDE");
    EXPECT_EQ(arguments({4, 4}), "DEHL m0");
    // What finds no place does not keep later ones from theirs.
    EXPECT_EQ(arguments({4, 4, 2, 1, 4}), "DEHL m0 BC A m4");
}

TEST(Abi, LargeValuesAreInMemory) {
    EXPECT_EQ(arguments({8, 2, 5, 1}), "m0 HL m8 A");
    EXPECT_EQ(place_arguments(std::vector<std::size_t>{8, 2, 5, 1}, false).memory_bytes, 13U);
}

TEST(Abi, HlIsTheTargetOfACallThroughAPointer) {
    EXPECT_EQ(arguments({2, 2, 2}, true), "DE BC m0");
    EXPECT_EQ(arguments({4}, true), "BCDE");
    EXPECT_EQ(arguments({3}, true), "ADE");
    EXPECT_EQ(arguments({1, 1, 1, 1, 1, 1}, true), "A C B E D m0");
}

TEST(Abi, ResultsAreWhereAFirstArgumentWouldBe) {
    EXPECT_EQ(shown(place_result(1)), "A");
    EXPECT_EQ(shown(place_result(2)), "HL");
    EXPECT_EQ(shown(place_result(3)), "AHL");
    EXPECT_EQ(shown(place_result(4)), "DEHL");
    EXPECT_EQ(shown(place_result(5)), "m0");
    EXPECT_EQ(place_result(8).memory_bytes, 8U);
    EXPECT_EQ(place_result(0).memory_bytes, 0U);
}

TEST(Abi, NamesCannotBeTheProgrammers) {
    EXPECT_EQ(signature_text(std::vector<std::size_t>{2, 1}, 4), "p2_1r4");
    EXPECT_EQ(signature_text({}, 0), "pr0");
    EXPECT_EQ(arguments_name("f"), "f@args");
    EXPECT_EQ(result_name("f"), "f@result");
    EXPECT_TRUE(is_shared_name(shared_arguments_name("pr0")));
    EXPECT_TRUE(is_shared_name(shared_result_name("pr0")));
    EXPECT_FALSE(is_shared_name(arguments_name("f")));
}

}  // namespace
