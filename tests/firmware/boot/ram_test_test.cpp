// ram_test_test.cpp - faults of cells and address lines are found, contents stay.
#include "firmware/boot/ram_test.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace {

/// 32 KB with one fault, behind pointers that read and write through it.
struct Memory {
    std::vector<std::uint8_t> bytes = std::vector<std::uint8_t>(32768);
    std::size_t stuck_at = ~std::size_t{0};
    std::uint8_t stuck_ones = 0, stuck_zeros = 0;
    unsigned lines_low = 0, lines_high = 0;  ///< stuck address lines
    unsigned short_a = 0, short_b = 0;       ///< two address lines in contact
    bool short_is_or = false;

    [[nodiscard]] std::size_t decode(std::size_t address) const {
        if (short_a != 0) {
            const bool a = (address & short_a) != 0;
            const bool b = (address & short_b) != 0;
            const bool level = short_is_or ? a || b : a && b;
            address &= ~std::size_t{short_a | short_b};
            if (level) address |= short_a | short_b;
        }
        return (address & ~std::size_t{lines_low}) | lines_high;
    }
    [[nodiscard]] std::uint8_t read(std::size_t address) const {
        const std::size_t cell = decode(address);
        std::uint8_t value = bytes[cell];
        if (cell == stuck_at)
            value = static_cast<std::uint8_t>((value | stuck_ones) & ~stuck_zeros);
        return value;
    }
    void write(std::size_t address, std::uint8_t value) { bytes[decode(address)] = value; }
};
Memory* memory;

/// A byte of it. Its address is its place among `cells`.
struct Cell {
    Cell& operator=(std::uint8_t value);
    operator std::uint8_t() const;  // NOLINT: as a byte of memory
};
Cell cells[32768];
Cell& Cell::operator=(std::uint8_t value) {
    memory->write(static_cast<std::size_t>(this - cells), value);
    return *this;
}
Cell::operator std::uint8_t() const {
    return memory->read(static_cast<std::size_t>(this - cells));
}

bool cells_hold(Cell* first, std::uint8_t count) {
    static bool hold;
    hold = true;
    rover::test_cells(first, count, [] { hold = false; });
    return hold;
}

bool pages_hold() {
    for (std::size_t page = 0; page < 128; ++page) {
        if (!cells_hold(&cells[page * 256], 0)) return false;
    }
    return true;
}

bool address_lines_hold() {
    static bool hold;
    hold = true;
    rover::test_address_lines(cells, 0x4000, [] { hold = false; });
    return hold;
}

class RamTest : public testing::Test {
protected:
    RamTest() {
        memory = &fitted;
        std::mt19937 random(6);
        for (std::uint8_t& byte : fitted.bytes) byte = static_cast<std::uint8_t>(random());
    }
    Memory fitted;
};

TEST_F(RamTest, GoodMemoryPassesAndKeepsItsContents) {
    const auto before = fitted.bytes;
    EXPECT_TRUE(pages_hold());
    EXPECT_TRUE(address_lines_hold());
    EXPECT_EQ(fitted.bytes, before);
}

TEST_F(RamTest, EveryStuckBitIsFound) {
    for (const std::size_t address : {0U, 1U, 255U, 256U, 0x1234U, 0x7FFFU}) {
        for (unsigned bit = 0; bit < 8; ++bit) {
            for (const bool one : {false, true}) {
                fitted.stuck_at = address;
                fitted.stuck_ones = static_cast<std::uint8_t>(one ? 1U << bit : 0U);
                fitted.stuck_zeros = static_cast<std::uint8_t>(one ? 0U : 1U << bit);
                EXPECT_FALSE(pages_hold()) << address << " bit " << bit << " stuck at " << one;
            }
        }
    }
}

TEST_F(RamTest, OnlyTheCountedCellsAreTouched) {
    fitted.stuck_at = 10;
    fitted.stuck_ones = 1;
    EXPECT_TRUE(cells_hold(cells, 10));
    EXPECT_FALSE(cells_hold(cells, 11));
}

TEST_F(RamTest, EveryStuckAddressLineIsFound) {
    for (unsigned line = 1; line <= 0x4000; line *= 2) {
        fitted.lines_low = line;
        fitted.lines_high = 0;
        EXPECT_FALSE(address_lines_hold()) << line << " low";
        fitted.lines_low = 0;
        fitted.lines_high = line;
        EXPECT_FALSE(address_lines_hold()) << line << " high";
    }
}

TEST_F(RamTest, EveryContactOfTwoAddressLinesIsFound) {
    for (unsigned a = 1; a <= 0x4000; a *= 2) {
        for (unsigned b = 1; b < a; b *= 2) {
            for (const bool is_or : {false, true}) {
                fitted.short_a = a;
                fitted.short_b = b;
                fitted.short_is_or = is_or;
                EXPECT_FALSE(address_lines_hold())
                    << a << " and " << b << (is_or ? ": the high one wins" : ": the low one wins");
            }
        }
    }
}

}  // namespace
