// start.cpp - first code behind every reset: into the image, or into the loader.
// Depends on   loader/boot_record.hpp, loader/protocol.hpp, hal, i85.h.
// Runs         from ROM, below kStartLast. Its RAM is the page of the application's stack.
// Flow         motors off -> asked for the loader, or a hello frame heard, or no bootable image?
//              -> copy the program to RAM and go there; else the application.
// Design note  docs/design/loader.md     Tests  tests/system/loader
#include <i85.h>

#include "firmware/executive/battery_area.hpp"
#include "firmware/loader/boot_record.hpp"
#include "firmware/loader/protocol.hpp"
#include "hal/board/rb85_parts.hpp"
#include "hal/target/i8085.hpp"

namespace rover::loader {
namespace {

using Parts = hal::Rb85Parts<hal::I8085>;

template <class T>
T* place(uint16_t address) {
    return reinterpret_cast<T*>(address);
}

/// Behind a jump to 0000H RESET has not done it.
void make_safe() {
    Parts::PpiA::set_mode<hal::rb85::kPpiAMode>();
    Parts::Motors::all_off();
    Parts::PpiB::set_mode<hal::rb85::kPpiBMode>();
}

void open_link() {
    Parts::TimerA::start<hal::rb85::kBaudCounter, Parts::TimerA::Mode::square_wave>(
        hal::rb85::kBaudCount);
    Parts::Usart::reset();
}

/// A pass without a character takes 48 T.
constexpr uint16_t kListenPasses = hal::rb85::kClockHz / 1000 * kListenMs / 48;

/// Does a hello frame come within the listening window?
bool hears_hello() {
    uint8_t taken = 0;
    for (uint16_t left = kListenPasses; left != 0; --left) {
        if (bit_and(Parts::Usart::status(), Parts::Usart::kRxReady) == 0) continue;
        const uint8_t byte = Parts::Usart::read();
        if (byte != kHelloFrame.bytes[taken]) taken = 0;
        if (byte == kHelloFrame.bytes[taken]) ++taken;
        if (taken == kFrameOverhead) return true;
    }
    return false;
}

/// Was the application told to go to the loader? Asks once: behind the loader it is a warm restart.
bool was_asked() {
    volatile uint8_t& mark = *place<volatile uint8_t>(hal::rb85::kCheckpointFirst + battery::kMark);
    if (mark != static_cast<uint8_t>(RunMark::loader)) return false;
    mark = static_cast<uint8_t>(RunMark::warm_restart);
    return true;
}

void go_to(uint16_t address) {
    place<void()>(address)();
}

void run_program(Entry entry) {
    const volatile uint8_t* from = place<const volatile uint8_t>(kStoredProgramFirst);
    volatile uint8_t* to = place<volatile uint8_t>(kProgramFirst);
    for (uint16_t left = kProgramSize; left != 0; --left) *to++ = *from++;
    *place<volatile uint8_t>(kEntryReason) = static_cast<uint8_t>(entry);
    go_to(kProgramFirst);
}

}  // namespace
}  // namespace rover::loader

int main() {  // tidy-allow(explicit-width): the language wants int
    using namespace rover::loader;
    make_safe();
    open_link();
    if (was_asked()) {
        run_program(Entry::asked);
    } else if (hears_hello()) {
        run_program(Entry::hello);
    } else if (record_is_whole(place<const volatile uint8_t>(kRecordPage))) {
        go_to(kApplicationFirst);
    } else {
        run_program(Entry::no_image);
    }
}
