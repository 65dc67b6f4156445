// boot_record_test.cpp - which records are whole.
#include "firmware/loader/boot_record.hpp"

#include <gtest/gtest.h>

#include <array>

namespace {

using rover::loader::record_is_whole;
using Record = std::array<uint8_t, rover::loader::kBootRecordSize>;

/// Puts the check in: bit by bit from the polynomial.
Record with_check(Record record) {
    unsigned crc = 0xFFFF;
    for (std::size_t i = 0; i < 10; ++i) {
        crc ^= unsigned{record[i]} << 8;
        for (int bit = 0; bit < 8; ++bit) {
            crc = (crc & 0x8000) != 0 ? crc << 1 ^ 0x1021 : crc << 1;
        }
    }
    record[10] = static_cast<uint8_t>(crc & 0xFF);
    record[11] = static_cast<uint8_t>(crc >> 8 & 0xFF);
    return record;
}

/// "R85B", an image up to 38EAH with CRC 1234H and its identity at 3784H.
Record good() {
    return with_check({'R', '8', '5', 'B', 0xEA, 0x38, 0x34, 0x12, 0x84, 0x37, 0, 0});
}

TEST(BootRecord, AGoodOneIsWhole) {
    EXPECT_TRUE(record_is_whole(good().data()));
}

TEST(BootRecord, AnyChangedBitOrTwoIsSeen) {
    for (unsigned first = 0; first < 96; ++first) {
        for (unsigned second = first; second < 96; ++second) {
            Record record = good();
            record[first / 8] = static_cast<uint8_t>(record[first / 8] ^ 1U << first % 8);
            if (second != first) {
                record[second / 8] = static_cast<uint8_t>(record[second / 8] ^ 1U << second % 8);
            }
            ASSERT_FALSE(record_is_whole(record.data())) << first << ' ' << second;
        }
    }
}

TEST(BootRecord, AnErasedPageIsNone) {
    Record record;
    record.fill(0xFF);
    EXPECT_FALSE(record_is_whole(record.data()));
    record.fill(0);
    EXPECT_FALSE(record_is_whole(record.data()));
}

TEST(BootRecord, OtherBytesWithARightCheckAreNone) {
    Record record = good();
    record[0] = 'S';
    record = with_check(record);
    EXPECT_FALSE(record_is_whole(record.data()));
}

}  // namespace
