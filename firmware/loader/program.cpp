// program.cpp - the loader: takes an image over the serial link and writes it into the EEPROM.
// Depends on   loader/eeprom.hpp, boot_record.hpp, protocol.hpp, hal, i85.h.
// Runs         from RAM at kProgramFirst, where start.cpp has copied it. No interrupts: the
//              receiver is polled, and TRAP is gated off until the application opens it.
// Flow         frame -> request -> EEPROM -> answer. Nothing but a boot record makes an image
//              bootable, and the first page is written only after the old record is gone.
// Motors       off since start.cpp, and nothing here addresses them.
// Normative    docs/spec/loader.md     Design note  docs/design/loader.md
#include <i85.h>

#include "firmware/app/identity.hpp"
#include "firmware/loader/boot_record.hpp"
#include "firmware/loader/eeprom.hpp"
#include "firmware/loader/protocol.hpp"
#include "hal/board/rb85_parts.hpp"
#include "hal/target/i8085.hpp"

namespace rover::loader {
namespace {

using Parts = hal::Rb85Parts<hal::I8085>;

volatile uint8_t* cell(uint16_t address) {
    return reinterpret_cast<volatile uint8_t*>(address);
}

struct Bus {
    static uint8_t get(uint16_t address) { return *cell(address); }
    static void put(uint16_t address, uint8_t byte) { *cell(address) = byte; }
};
using Eeprom = EepromWriter<Bus>;

uint8_t payload[ToLoader::kPayloadMax];  ///< of the request
uint8_t answer[FromLoader::kPayloadMax];
uint8_t page[kPageSize];  ///< the record page, as it is to be
Report report;
Hello hello;
bool is_open;

// -- The line ------------------------------------------------------------------------------------

/// A pass takes 79 T.
constexpr uint16_t kWaitMs = 50;
constexpr uint16_t kWaitPasses = hal::rb85::kClockHz / 1000 * kWaitMs / 79;
constexpr uint8_t kWaitsMax = kPatienceMs / kWaitMs;

/// Waits for a character, kWaitMs at most. The watchdog gets its edge here.
[[gnu::noinline]] bool comes() {
    Parts::Watchdog::toggle();
    for (uint16_t left = kWaitPasses; left != 0; --left) {
        if (bit_and(Parts::Usart::status(), Parts::Usart::kRxReady) != 0) return true;
    }
    return false;
}

struct Head {
    uint8_t type;
    uint8_t size;
};
Head request;

/// The next character of a frame. @return  false: none came, or none that was whole
[[gnu::noinline]] bool take(uint8_t& byte) {
    if (!comes()) return false;
    const uint8_t errors = bit_and(Parts::Usart::status(), Parts::Usart::kErrors);
    byte = Parts::Usart::read();
    if (errors == 0) return true;
    Parts::Usart::acknowledge_errors();
    return false;
}

uint16_t line_crc;

/// The same, counted into the check.
[[gnu::noinline]] bool take_checked(uint8_t& byte) {
    if (!take(byte)) return false;
    line_crc = crc16_add_small(line_crc, byte);
    return true;
}

/// What follows the sync bytes. @return  false: no good frame; look for sync bytes again
[[gnu::noinline]] bool take_frame() {
    line_crc = kCrc16Start;
    if (!take_checked(request.type) || !take_checked(request.size)) return false;
    if (request.size > ToLoader::kPayloadMax) return false;
    uint8_t* to = payload;
    for (uint8_t left = request.size; left != 0; --left) {
        if (!take_checked(*to++)) return false;
    }
    uint8_t low;
    uint8_t high;
    const uint16_t crc = line_crc;
    if (!take(low) || !take(high)) return false;
    return low == narrow_wrap_u8(crc) && high == narrow_wrap_u8(shift_floor<8>(crc));
}

[[gnu::noinline]] void put(uint8_t byte) {
    while (bit_and(Parts::Usart::status(), Parts::Usart::kTxReady) == 0) {
        I85_LOOP_BOUND(100);
    }
    Parts::Usart::write(byte);
}

[[gnu::noinline]] void put_checked(uint8_t byte) {
    line_crc = crc16_add_small(line_crc, byte);
    put(byte);
}

void send(const void* content, uint8_t size) {
    put(FromLoader::kSync0);
    put(FromLoader::kSync1);
    line_crc = kCrc16Start;
    put_checked(bit_or(request.type, kAnswerBit));
    put_checked(size);
    const uint8_t* from = static_cast<const uint8_t*>(content);
    for (; size != 0; --size) put_checked(*from++);
    const uint16_t crc = line_crc;
    put(narrow_wrap_u8(crc));
    put(narrow_wrap_u8(shift_floor<8>(crc)));
}

// -- The EEPROM ----------------------------------------------------------------------------------

uint16_t word_at(const volatile uint8_t* at) {
    const uint8_t low = at[0];
    return bit_or(widen_u16(low), shift_left_wrap<8>(widen_u16(uint8_t{at[1]})));
}

[[gnu::noinline]] void report_at(Result result, uint16_t address) {
    report.result = result;
    report.address[0] = narrow_wrap_u8(address);
    report.address[1] = narrow_wrap_u8(shift_floor<8>(address));
}

/// Do 64 bytes of the EEPROM hold this? Reports the first that does not.
[[gnu::noinline]] bool holds(uint16_t address, const uint8_t* bytes) {
    for (uint8_t left = kPageSize; left != 0; --left) {
        const uint8_t found = *cell(address);
        const uint8_t expected = *bytes++;
        if (found != expected) {
            report_at(Result::differs, address);
            report.expected = expected;
            report.found = found;
            return false;
        }
        address = add_wrap(address, uint16_t{1});
    }
    return true;
}

/// Writes a page that is not yet what it should be, and reads it back.
[[gnu::noinline]] bool program(uint16_t address, const uint8_t* bytes) {
    if (holds(address, bytes)) return true;
    if (!Eeprom::write(address, bytes)) {
        report_at(Result::no_end, address);
        return false;
    }
    report.result = Result::done;
    return holds(address, bytes);
}

bool image_is_bootable() {
    return record_is_whole(cell(kRecordPage));
}

/// The record page, erased but for a record.
[[gnu::noinline]] bool program_record(const BootRecord* record) {
    for (uint8_t& byte : page) byte = 0xFF;
    if (record != nullptr) *reinterpret_cast<BootRecord*>(page) = *record;
    return program(kRecordPage, page);
}

// -- Requests ------------------------------------------------------------------------------------

void answer_hello() {
    hello.is_open = is_open ? 1 : 0;
    hello.bootable = 0;
    if (image_is_bootable()) {
        hello.bootable = 1;
        const uint16_t identity =
            word_at(cell(kRecordPage + __builtin_offsetof(BootRecord, identity_at)));
        const volatile uint8_t* from = cell(add_wrap(identity, uint16_t{sizeof Identity::magic}));
        for (uint8_t& byte : hello.identity) byte = *from++;
    }
    send(&hello, sizeof hello);
}

bool is_page_of_application(uint16_t address) {
    return address >= kApplicationFirst && address <= kApplicationLast &&
           bit_and(narrow_wrap_u8(address), uint8_t{kPageSize - 1}) == 0;
}

void write_page() {
    const uint16_t address = word_at(payload);
    if (!is_page_of_application(address)) {
        report_at(Result::wrong_address, address);
    } else if (!is_open) {
        report_at(Result::not_open, address);
    } else {
        program(address, payload + 2);
    }
}

/// CRC-16 of each of `count` pages behind the address in the answer.
void answer_checks(uint16_t address, uint8_t count) {
    uint8_t* to = answer + 2;
    for (uint8_t left = count; left != 0; --left) {
        const uint16_t crc = crc16_small(kCrc16Start, cell(address), kPageSize);
        *to++ = narrow_wrap_u8(crc);
        *to++ = narrow_wrap_u8(shift_floor<8>(crc));
        address = add_wrap(address, kPageSize);
        Parts::Watchdog::toggle();
    }
    send(answer, add_wrap(shift_left_wrap<1>(count), uint8_t{2}));
}

void answer_bytes(uint16_t address, uint8_t count) {
    uint8_t* to = answer + 2;
    const volatile uint8_t* from = cell(address);
    for (uint8_t left = count; left != 0; --left) *to++ = *from++;
    send(answer, add_wrap(count, uint8_t{2}));
}

/// CRC-16 of the image, its own field counted as zero.
[[gnu::noinline]] uint16_t image_crc(uint16_t end, uint16_t field) {
    uint16_t crc = kCrc16Start;
    for (uint16_t at = kApplicationFirst; at != end; at = add_wrap(at, uint16_t{1})) {
        if (narrow_wrap_u8(at) == 0) Parts::Watchdog::toggle();
        const bool counts = shift_floor<1>(sub_wrap(at, field)) != 0;
        crc = crc16_add_small(crc, counts ? *cell(at) : uint8_t{0});
    }
    return crc;
}

bool identity_stands_at(uint16_t address) {
    if (address < kApplicationFirst || address > kRecordPage - sizeof(Identity)) return false;
    const volatile uint8_t* at = cell(address);
    for (const uint8_t letter : kIdentity.magic) {
        if (*at++ != letter) return false;
    }
    return *at == kIdentityFormat;
}

/// Verifies the image that has been written and makes it bootable.
void close() {
    const uint16_t identity = word_at(payload);
    if (!is_open) return report_at(Result::not_open, identity);
    if (!identity_stands_at(identity)) return report_at(Result::no_identity, identity);
    const volatile uint8_t* const block = cell(identity);
    BootRecord record;
    for (uint8_t i = 0; i < sizeof kRecordMagic; ++i) record.magic[i] = kRecordMagic[i];
    record.image_size = word_at(block + __builtin_offsetof(Identity, image_size));
    record.image_crc = word_at(block + __builtin_offsetof(Identity, image_crc));
    record.identity_at = identity;
    const uint16_t behind = add_wrap(identity, uint16_t{sizeof(Identity)});
    if (record.image_size < behind || record.image_size > kRecordPage) {
        return report_at(Result::wrong_image_size, record.image_size);
    }
    const uint16_t field = add_wrap(identity, uint16_t{__builtin_offsetof(Identity, image_crc)});
    const uint16_t crc = image_crc(record.image_size, field);
    if (crc != record.image_crc) return report_at(Result::wrong_crc, crc);
    record.crc =
        crc16_small(kCrc16Start, reinterpret_cast<const uint8_t*>(&record), kBootRecordChecked);
    if (program_record(&record)) is_open = false;
}

/// Into the image by a reset: the watchdog gets no more edges, and every part is as RESET leaves
/// it.
void wait_for_reset() {
    for (;;) hal::I8085::halt();
}

/// Which size a request has to have.
uint8_t wanted_size(Request type) {
    if (type == Request::write) return 2 + kPageSize;
    if (type == Request::check || type == Request::read) return 3;
    return type == Request::close ? 2 : 0;
}

/// What `check` and `read` ask for: address, count, in the EEPROM.
bool answer_content(Request type) {
    const uint16_t address = word_at(payload);
    const uint8_t count = payload[2];
    const uint8_t most = type == Request::check ? kChecksMax : uint8_t{kPageSize};
    if (address > hal::rb85::kEepromLast || count == 0 || count > most) {
        report_at(Result::wrong_address, address);
        return false;
    }
    answer[0] = payload[0];
    answer[1] = payload[1];
    if (type == Request::check) {
        answer_checks(address, count);
    } else {
        answer_bytes(address, count);
    }
    return true;
}

void answer_request() {
    const auto type = static_cast<Request>(request.type);
    report.result = Result::done;
    if (request.type < static_cast<uint8_t>(Request::hello) ||
        request.type > static_cast<uint8_t>(Request::start)) {
        report.result = Result::unknown_type;
    } else if (request.size != wanted_size(type)) {
        report.result = Result::wrong_size;
    } else if (type == Request::hello) {
        return answer_hello();
    } else if (type == Request::open) {
        is_open = program_record(nullptr);
    } else if (type == Request::write) {
        write_page();
    } else if (type == Request::close) {
        close();
    } else if (type == Request::start) {
        if (!image_is_bootable()) report.result = Result::not_bootable;
    } else if (answer_content(type)) {
        return;
    }
    send(&report, sizeof report);
    if (type == Request::start && report.result == Result::done) wait_for_reset();
}

}  // namespace
}  // namespace rover::loader

int main() {  // tidy-allow(explicit-width): the language wants int
    using namespace rover::loader;
    hello = {kProtocolVersion,
             kLoaderVersion,
             {kApplicationFirst % 256, kApplicationFirst / 256},
             {kRecordPage % 256, kRecordPage / 256},
             kPageSize,
             static_cast<Entry>(*cell(kEntryReason)),
             0,
             0,
             {}};
    uint8_t waits = kWaitsMax;
    bool opened = false;  // the last character was the first of a frame
    for (;;) {
        uint8_t byte;
        if (!take(byte)) {
            opened = false;
            if (--waits == 0) wait_for_reset();
        } else if (opened && byte == ToLoader::kSync1) {
            opened = false;
            if (!take_frame()) continue;
            answer_request();
            waits = kWaitsMax;
        } else {
            opened = byte == ToLoader::kSync0;
        }
    }
}
