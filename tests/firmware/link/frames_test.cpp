// frames_test.cpp - frames are found in any stream, written as the page says, and the page is true.
#include "firmware/link/frames.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "tests/support/page_table.hpp"

namespace {

using Bytes = std::vector<std::uint8_t>;

/// CRC-16/CCITT-FALSE, bit by bit from its polynomial.
std::uint16_t check_of(const Bytes& bytes) {
    unsigned crc = 0xFFFF;
    for (const std::uint8_t byte : bytes) {
        for (int bit = 7; bit >= 0; --bit) {
            const bool one = ((crc >> 15) ^ (byte >> bit & 1U)) != 0;
            crc = (crc << 1 & 0xFFFFU) ^ (one ? 0x1021U : 0U);
        }
    }
    return static_cast<std::uint16_t>(crc);
}

/// An uplink frame by the page, byte by byte.
Bytes uplink(std::uint8_t type, const Bytes& payload) {
    Bytes content = {type, static_cast<std::uint8_t>(payload.size())};
    for (const std::uint8_t byte : payload) content.push_back(byte);
    const std::uint16_t check = check_of(content);
    Bytes frame = {0xC5, 0x3A};
    for (const std::uint8_t byte : content) frame.push_back(byte);
    frame.push_back(static_cast<std::uint8_t>(check & 0xFF));
    frame.push_back(static_cast<std::uint8_t>(check >> 8));
    return frame;
}

struct Found {
    std::uint8_t type = 0;
    Bytes payload;
    bool operator==(const Found&) const = default;
};
void PrintTo(const Found& found, std::ostream* stream) {
    *stream << "type " << int{found.type} << ", " << found.payload.size() << " bytes";
}

std::vector<Found> parse(rover::UplinkParser& parser, const Bytes& stream) {
    std::vector<Found> found;
    for (const std::uint8_t byte : stream) {
        if (parser.take(byte)) {
            found.push_back({parser.type(), {parser.payload(), parser.payload() + parser.size()}});
        }
    }
    return found;
}

void append(Bytes& stream, const Bytes& more) {
    for (const std::uint8_t byte : more) stream.push_back(byte);
}

TEST(UplinkParser, TheFramesOfThePageByHand) {
    rover::UplinkParser parser;
    // The check of 02 00 is 7B6Dh, that of 01 00 is 2E3Eh (a table-driven script in another
    // language).
    const auto found = parse(parser, {0xC5, 0x3A, 0x02, 0x00, 0x6D, 0x7B,  //
                                      0xC5, 0x3A, 0x01, 0x00, 0x3E, 0x2E,  //
                                      0xC5, 0x3A, 0x01, 0x00, 0x3E, 0x2F});
    EXPECT_EQ(found, (std::vector<Found>{{2, {}}, {1, {}}}));
    EXPECT_EQ(parser.refused, 1);
}

TEST(UplinkParser, EverySizeUpToTheLargest) {
    for (std::size_t size = 0; size <= 48; ++size) {
        Bytes payload;
        for (std::size_t i = 0; i < size; ++i) {
            payload.push_back(static_cast<std::uint8_t>(7 * i + size));
        }
        rover::UplinkParser parser;
        EXPECT_EQ(parse(parser, uplink(3, payload)), (std::vector<Found>{{3, payload}}));
        EXPECT_EQ(parser.refused, 0);
    }
}

TEST(UplinkParser, ALargerSizeIsRefusedAtOnce) {
    for (unsigned size = 49; size <= 255; ++size) {
        rover::UplinkParser parser;
        parse(parser, {0xC5, 0x3A, 0x03, static_cast<std::uint8_t>(size)});
        EXPECT_EQ(parser.refused, 1);
        EXPECT_EQ(parse(parser, uplink(2, {})).size(), 1u);
    }
}

TEST(UplinkParser, RepeatedSyncBytesBeforeAFrameDoNoHarm) {
    rover::UplinkParser parser;
    Bytes stream = {0xC5, 0xC5, 0xC5, 0x00, 0x3A, 0xC5};
    append(stream, uplink(1, {}));
    EXPECT_EQ(parse(parser, stream).size(), 1u);
    EXPECT_EQ(parser.refused, 0);
}

TEST(UplinkParser, EveryWrongBitIsNoticedAndTheNextFrameButOneIsFound) {
    const Bytes good = uplink(3, {1, 2, 3, 0xC5, 0x3A, 4});
    for (std::size_t bit = 0; bit < good.size() * 8; ++bit) {
        Bytes bad = good;
        bad[bit / 8] = static_cast<std::uint8_t>(bad[bit / 8] ^ 1U << bit % 8);
        rover::UplinkParser parser;
        EXPECT_TRUE(parse(parser, bad).empty()) << "bit " << bit;
        // A damaged size can make it wait for up to 48 bytes more; a pause ends that.
        parser.quiet();
        EXPECT_EQ(parse(parser, good).size(), 1u) << "bit " << bit;
    }
}

TEST(UplinkParser, FindsItsWayBackFromAnyDamage) {
    for (unsigned seed = 1; seed <= 200; ++seed) {
        std::mt19937 random(seed);
        Bytes stream;
        std::size_t intact_in_a_row = 0;
        std::vector<bool> must_be_found;
        for (int frame = 0; frame < 200; ++frame) {
            Bytes payload(random() % 49);
            for (std::uint8_t& byte : payload) byte = static_cast<std::uint8_t>(random());
            Bytes bytes = uplink(static_cast<std::uint8_t>(frame), payload);
            const bool damaged = random() % 4 == 0;
            if (damaged) {
                const std::size_t place = random() % bytes.size();
                switch (random() % 3) {
                    case 0:
                        bytes[place] =
                            static_cast<std::uint8_t>(bytes[place] ^ (1 + random() % 255));
                        break;
                    case 1:
                        bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(place));
                        break;
                    default:
                        bytes.resize(place);
                }
            }
            intact_in_a_row = damaged ? 0 : intact_in_a_row + bytes.size();
            // 48 bytes, check and sync bytes behind the damage it has found its way back.
            must_be_found.push_back(!damaged && intact_in_a_row > 3 * 54);
            append(stream, bytes);
        }
        rover::UplinkParser parser;
        std::vector<bool> seen(200);
        for (const Found& found : parse(parser, stream)) seen[found.type] = true;
        for (std::size_t frame = 0; frame < 200; ++frame) {
            EXPECT_TRUE(seen[frame] || !must_be_found[frame]) << "seed " << seed << " " << frame;
        }
    }
}

TEST(UplinkParser, NoiseLeavesItUsable) {
    const unsigned seed = 4;
    std::mt19937 random(seed);
    rover::UplinkParser parser;
    for (int i = 0; i < 1'000'000; ++i) {
        // Sync bytes often enough to reach every state.
        const std::uint8_t choices[4] = {0xC5, 0x3A, static_cast<std::uint8_t>(random() % 60),
                                         static_cast<std::uint8_t>(random())};
        parser.take(choices[random() % 4]);
        ASSERT_LT(parser.taken, 48 + rover::kFrameOverhead);
    }
    parser.quiet();
    EXPECT_EQ(parse(parser, uplink(1, {})).size(), 1u) << "seed " << seed;
}

struct Sink {
    Bytes bytes;
    void push_all(const volatile std::uint8_t* from, std::uint8_t count) {
        for (; count != 0; --count) bytes.push_back(std::uint8_t{*from++});
    }
};

TEST(WriteFrame, IsTheFrameOfThePage) {
    for (std::size_t size = 0; size <= 48; ++size) {
        Bytes payload(size, static_cast<std::uint8_t>(0x30 + size));
        Sink sink;
        rover::write_frame<rover::Uplink>(sink, 9, payload.data(), static_cast<std::uint8_t>(size));
        EXPECT_EQ(sink.bytes, uplink(9, payload));
        EXPECT_EQ(sink.bytes.size(), size + rover::kFrameOverhead);
    }
}

TEST(WriteFrame, TheGroundReadsWhatTheRoverWrites) {
    const Bytes payload = {1, 0xA5, 0x5A, 4};
    Sink sink;
    rover::write_frame<rover::Downlink>(sink, 0x81, payload.data(), 4);
    EXPECT_EQ(sink.bytes[0], 0xA5);
    EXPECT_EQ(sink.bytes[1], 0x5A);
    rover::DownlinkParser parser;
    int found = 0;
    for (const std::uint8_t byte : sink.bytes) found += parser.take(byte) ? 1 : 0;
    EXPECT_EQ(found, 1);
    EXPECT_EQ(parser.type(), 0x81);
    EXPECT_EQ(Bytes(parser.payload(), parser.payload() + parser.size()), payload);
}

// -- The page ------------------------------------------------------------------------------------

using test_support::Row;

std::vector<Row> table_of(const std::string& heading) {
    return test_support::table_of("docs/spec/link.md", heading);
}

/// "03h" and "3" are three.
int number(const std::string& text) {
    const bool hex = text.ends_with("h");
    return std::stoi(text, nullptr, hex ? 16 : 10);
}

TEST(LinkPage, NamesEveryTypeOfUplinkFrame) {
    const auto rows = table_of("## Uplink frames");
    ASSERT_EQ(rows.size(), 4u);
    const std::vector<std::pair<rover::UplinkType, std::string>> types = {
        {rover::UplinkType::identity, "identity"},
        {rover::UplinkType::status, "status"},
        {rover::UplinkType::calibration, "calibration"},
        {rover::UplinkType::restart, "restart"}};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_EQ(number(rows[i][0]), static_cast<int>(types[i].first));
        EXPECT_EQ(rows[i][1], types[i].second);
    }
}

TEST(LinkPage, NamesEveryKindOfDownlinkFrame) {
    const auto rows = table_of("## Downlink frames");
    ASSERT_EQ(rows.size(), 4u);
    const std::vector<std::pair<rover::DownlinkKind, std::string>> kinds = {
        {rover::DownlinkKind::telemetry, "telemetry"},
        {rover::DownlinkKind::identity, "identity"},
        {rover::DownlinkKind::status, "status"},
        {rover::DownlinkKind::acknowledge, "acknowledge"}};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_EQ(number(rows[i][0]), static_cast<int>(kinds[i].first));
        EXPECT_EQ(rows[i][1], kinds[i].second);
    }
}

TEST(LinkPage, NamesEveryResult) {
    const auto rows = table_of("### acknowledge");
    ASSERT_EQ(rows.size(), 4u);
    const std::vector<std::pair<rover::AckResult, std::string>> results = {
        {rover::AckResult::done, "done"},
        {rover::AckResult::unknown_type, "unknown_type"},
        {rover::AckResult::wrong_size, "wrong_size"},
        {rover::AckResult::refused, "refused"}};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_EQ(number(rows[i][0]), static_cast<int>(results[i].first));
        EXPECT_EQ(rows[i][1], results[i].second);
    }
}

TEST(LinkPage, StatesTheFormatOfFrames) {
    const auto rows = table_of("## Frame");
    ASSERT_EQ(rows.size(), 6u);
    EXPECT_EQ(number(rows[0][2]), rover::Uplink::kSync0);
    EXPECT_EQ(number(rows[0][3]), rover::Downlink::kSync0);
    EXPECT_EQ(number(rows[1][2]), rover::Uplink::kSync1);
    EXPECT_EQ(number(rows[1][3]), rover::Downlink::kSync1);
    EXPECT_EQ(rows[3][2], "0 to " + std::to_string(rover::Uplink::kPayloadMax));
    EXPECT_EQ(rows[3][3], "0 to " + std::to_string(rover::Downlink::kPayloadMax));
}

}  // namespace
