// loader_client_test.cpp - the PC's side of the loader's protocol against a scripted loader: what
// it sends, what it takes for an answer, when it asks again and when it gives up.
#include "host_sim/bind/loader_client.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>

#include "host_sim/bind/port_line.hpp"

namespace {

using host_sim::ByteLine;
using host_sim::LoaderClient;
using host_sim::LoaderError;
using rover::loader::Result;
using std::chrono::milliseconds;
using Bytes = std::vector<uint8_t>;

/// A downlink frame by docs/spec/link.md.
Bytes answer(uint8_t type, const Bytes& payload) {
    Bytes bytes;
    for (const std::size_t byte :
         {std::size_t{0xA5}, std::size_t{0x5A}, std::size_t{type}, payload.size()}) {
        bytes.push_back(static_cast<uint8_t>(byte));
    }
    for (const uint8_t byte : payload) bytes.push_back(byte);
    const uint16_t crc = host_sim::link_crc(std::span(bytes).subspan(2));
    bytes.push_back(static_cast<uint8_t>(crc & 0xFF));
    bytes.push_back(static_cast<uint8_t>(crc >> 8));
    return bytes;
}

/// A line with answers that are ready: one for each frame that is sent, or none.
struct Script {
    std::vector<Bytes> sent;
    std::deque<Bytes> answers;
    std::deque<uint8_t> waiting;

    ByteLine line() {
        ByteLine made;
        made.write = [this](std::span<const uint8_t> bytes) {
            sent.emplace_back(bytes.begin(), bytes.end());
            if (answers.empty()) return;
            waiting.insert(waiting.end(), answers.front().begin(), answers.front().end());
            answers.pop_front();
        };
        made.read = [this](std::span<uint8_t> buffer, milliseconds) -> std::size_t {
            if (waiting.empty()) return 0;
            buffer[0] = waiting.front();
            waiting.pop_front();
            return 1;
        };
        return made;
    }
};

constexpr LoaderClient::Options kQuick{
    .answer = milliseconds(5), .tries = 3, .close = milliseconds(5)};

Bytes hello_payload() {
    Bytes payload = {1, 1, 0x00, 0x0C, 0xC0, 0x7F, 64,   2,    0,    1,  // up to the identity
                     1, 0, 1,    0,    0x78, 0x56, 0x34, 0x12, 0xEA, 0x38, 0x0C, 0xA4};
    for (const char letter : std::string("Rocky3.2")) {
        payload.push_back(static_cast<uint8_t>(letter));
    }
    return payload;
}

TEST(LoaderClient, HelloIsTakenApart) {
    Script script;
    script.answers = {answer(0x90, hello_payload())};
    const auto hello = LoaderClient(script.line(), kQuick).hello();
    EXPECT_EQ(script.sent.at(0),
              (Bytes{0xC5, 0x3A, 0x10, 0x00, script.sent[0][4], script.sent[0][5]}));
    EXPECT_EQ(hello.application_first, 0x0C00);
    EXPECT_EQ(hello.application_end, 0x7FC0);
    EXPECT_EQ(hello.page_size, 64);
    EXPECT_EQ(hello.entry, rover::loader::Entry::asked);
    EXPECT_FALSE(hello.is_open);
    ASSERT_TRUE(hello.identity);
    EXPECT_EQ(describe(*hello.identity),
              "rover85 0.1.0 sources 12345678 vehicle Rocky3.2, CRC-16 A40CH");
}

TEST(LoaderClient, APageGoesBehindItsAddress) {
    Script script;
    script.answers = {answer(0x92, {6, 0x41, 0x0C, 0x12, 0x34})};
    LoaderClient client(script.line(), kQuick);
    const Bytes page(64, 0x5A);
    const auto report = client.write(0x0C40, page);
    EXPECT_EQ(report.result, Result::differs);
    EXPECT_EQ(report.address, 0x0C41);
    EXPECT_EQ(report.expected, 0x12);
    EXPECT_EQ(report.found, 0x34);
    const Bytes& frame = script.sent.at(0);
    EXPECT_EQ(frame[2], 0x12);
    EXPECT_EQ(frame[3], 66);
    EXPECT_EQ(frame[4], 0x40);
    EXPECT_EQ(frame[5], 0x0C);
    EXPECT_EQ(Bytes(frame.begin() + 6, frame.end() - 2), page);
}

TEST(LoaderClient, ChecksAndBytesBelongToTheirAddress) {
    Script script;
    script.answers = {answer(0x93, {0x00, 0x0C, 0x34, 0x12, 0x78, 0x56}),
                      answer(0x94, {0x00, 0x0C, 1, 2, 3}), answer(0x94, {0x40, 0x0C, 1, 2, 3}),
                      answer(0x93, {3, 0, 0x0C, 0, 0})};
    LoaderClient client(script.line(), kQuick);
    EXPECT_EQ(client.check(0x0C00, 2), (std::vector<uint16_t>{0x1234, 0x5678}));
    EXPECT_EQ(client.read(0x0C00, 3), (Bytes{1, 2, 3}));
    EXPECT_THROW((void)client.read(0x0C00, 3), LoaderError) << "another address";
    EXPECT_THROW((void)client.check(0x0C00, 2), LoaderError) << "a refusal";
}

TEST(LoaderClient, AsksAgainAndThenGivesUp) {
    Script script;
    script.answers = {{}, {0x00, 0xA5, 0x5A}, answer(0x91, {0, 0, 0, 0, 0})};
    LoaderClient client(script.line(), kQuick);
    EXPECT_EQ(client.open().result, Result::done);
    EXPECT_EQ(script.sent.size(), 3u);
    EXPECT_EQ(client.repeated(), 2u);
    EXPECT_THROW((void)client.open(), LoaderError);
    EXPECT_EQ(script.sent.size(), 6u);
}

TEST(LoaderClient, OtherFramesAreNoAnswer) {
    Script script;
    Bytes both = answer(0x01, Bytes(44));
    for (const uint8_t byte : answer(0x91, Bytes(5))) both.push_back(byte);
    script.answers = {both};
    EXPECT_EQ(LoaderClient(script.line(), kQuick).open().result, Result::done);
}

TEST(LoaderClient, ReachTellsTheImageAndOffersHelloFrames) {
    Script script;
    LoaderClient client(script.line(), kQuick);
    bool told = false;
    EXPECT_THROW((void)client.reach(milliseconds(2600), [&] { told = true; }), LoaderError);
    EXPECT_TRUE(told);
    const Bytes restart = host_sim::uplink_frame(host_sim::UplinkType::restart, Bytes{2});
    EXPECT_GT(std::count(script.sent.begin(), script.sent.end(), restart), 3);
    EXPECT_GT(std::count(script.sent.begin(), script.sent.end(), host_sim::uplink_frame(0x10)), 35);
}

TEST(RemoteIdentity, OtherFormatsAndSizesAreNone) {
    EXPECT_FALSE(host_sim::parse_identity(Bytes(19, 1)));
    EXPECT_FALSE(host_sim::parse_identity(Bytes(20, 2)));
    EXPECT_TRUE(host_sim::parse_identity(Bytes(20, 1)));
}

TEST(PortLine, OfAPortThatIsNotThere) {
    EXPECT_THROW(host_sim::SerialPort("/dev/no_such_port"), host_sim::SerialError);
}

}  // namespace
