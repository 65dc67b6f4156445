// recording_bus.hpp - a Bus that writes down every access and answers from a script.
// Depends on   GoogleTest.
// Use          RecordingBus::Script bus;  bus.in(0x21, {0x40, 0x00});  ...driver...
//              EXPECT_EQ(bus.accesses(), ...) - ports and values as hexadecimal text, so that a
//              list of accesses reads as the data sheet's.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <initializer_list>
#include <string>

namespace test_support {

struct RecordingBus {
    /// The record of one test, and what IN answers.
    class Script {
    public:
        Script() { current_ = this; }
        ~Script() { current_ = nullptr; }
        Script(const Script&) = delete;
        Script& operator=(const Script&) = delete;

        /// Values that IN `port` yields one behind the other; the last one for ever.
        void in(uint8_t port, std::initializer_list<uint8_t> values) { answers_[port] = values; }
        /// Everything since the last call, separated by blanks: "09=40" is OUT, "<21" is IN,
        /// "SIM=C0", "EI", "DI", "HLT", "RIM".
        std::string accesses() {
            std::string all;
            all.swap(accesses_);
            return all;
        }

    private:
        friend struct RecordingBus;
        void add(const char* format, unsigned one = 0, unsigned two = 0) {
            std::array<char, 16> text{};
            std::snprintf(text.data(), text.size(), format, one, two);
            if (!accesses_.empty()) accesses_ += ' ';
            accesses_ += text.data();
        }
        uint8_t answer(uint8_t port) {
            std::deque<uint8_t>& values = answers_[port];
            if (values.empty()) {
                ADD_FAILURE() << "IN " << unsigned{port} << " is not in the script";
                return 0xFF;
            }
            const uint8_t value = values.front();
            if (values.size() > 1) values.pop_front();
            return value;
        }

        std::array<std::deque<uint8_t>, 256> answers_;
        std::string accesses_;
        static inline Script* current_ = nullptr;
    };

    template <uint8_t kPort>
    static uint8_t in() {
        script().add("<%02X", kPort);
        return script().answer(kPort);
    }
    template <uint8_t kPort>
    static void out(uint8_t value) {
        script().add("%02X=%02X", kPort, value);
    }
    static uint8_t rim() {
        script().add("RIM");
        return 0;
    }
    static void sim(uint8_t value) { script().add("SIM=%02X", value); }
    static void enable_interrupts() { script().add("EI"); }
    static void disable_interrupts() { script().add("DI"); }
    static void halt() { script().add("HLT"); }

private:
    static Script& script() { return *Script::current_; }
};

}  // namespace test_support
