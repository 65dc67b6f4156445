// main.cpp - the image: board, boot, schedule and controller bound together.
// Depends on   everything of firmware and hal; i85.h for the interrupt functions.
// Flow         boot -> { wait for the tick -> acquire -> control -> motors -> telemetry and link ->
//              checkpoint -> watchdog } ten times a second.
// Interrupts   tick (RST 7.5), receive (6.5), transmit (5.5), TRAP: they store and return. What
//              they share with the main line is volatile, with one writer a byte.
// Design note  docs/design/executive.md, docs/design/boot.md
// Tests        tests/system/image
#include <i85.h>

#include "firmware/app/identity.hpp"
#include "firmware/boot/ram_test.hpp"
#include "firmware/boot/reset_cause.hpp"
#include "firmware/boot/rom_check.hpp"
#include "firmware/boot/stack_guard.hpp"
#include "firmware/config/eeprom_layout.hpp"
#include "firmware/config/memory_layout.hpp"
#include "firmware/executive/acquisition.hpp"
#include "firmware/executive/checkpoint.hpp"
#include "firmware/executive/controller.hpp"
#include "firmware/executive/motor_commands.hpp"
#include "firmware/executive/schedule.hpp"
#include "firmware/executive/servo_loops.hpp"
#include "firmware/link/byte_ring.hpp"
#include "firmware/link/calibration_frame.hpp"
#include "firmware/link/frames.hpp"
#include "hal/board/rb85_parts.hpp"
#include "hal/target/i8085.hpp"

namespace rover {
namespace {

using Bus = hal::I8085;
using Parts = hal::Rb85Parts<Bus>;

// SIM: bit 3 sets the masks. RST 7.5 and 6.5 are always open, 5.5 while there is something to send.
constexpr uint8_t kOpenAll = 0x08;
constexpr uint8_t kMaskTransmit = 0x09;
constexpr uint8_t kForgetTick = 0x10;  // a tick that came before

// -- What interrupts and main line share ---------------------------------------------------------

WheelCount wheels[hal::kWheelCount];
alignas(128) ByteRing<64> received;
alignas(256) PageRing to_send;
uint8_t ticks_to_count;  // the tick's
ServoLoops servos;
volatile uint16_t receive_errors;
volatile uint8_t trap_count;

// -- The main line's own -------------------------------------------------------------------------

/// Cleared by the start-up, then set_initial_values(): its initial value would be 440 bytes of ROM.
union ControllerPlace {
    uint8_t cleared = 0;
    Controller value;
};
alignas(256) ControllerPlace controller_place;
Controller& controller = controller_place.value;
alignas(128) hal::RawInputs inputs;
hal::Commands commands;
Schedule schedule;
UplinkParser uplink;
CheckpointPlace checkpoint;
BoardStatus status;
uint16_t link_bytes;  // taken out of the receive ring
bool restarting;

volatile uint8_t* battery_area() {
    return reinterpret_cast<volatile uint8_t*>(hal::rb85::kCheckpointFirst);
}
volatile uint8_t* stack_guard() {
    return reinterpret_cast<volatile uint8_t*>(kStackGuardFirst);
}
volatile uint8_t& main_faults() {
    return battery_area()[battery::kFaults];
}
volatile uint8_t& trap_faults() {
    return battery_area()[battery::kFaults + 1];
}
[[gnu::noinline]] void set_fault(BoardFault fault) {
    main_faults() = bit_or(uint8_t{main_faults()}, static_cast<uint8_t>(fault));
}
/// Faults with which motors stay off.
uint8_t stop_bits() {
    return bit_or(bit_and(uint8_t{main_faults()}, kFaultsThatStop), uint8_t{trap_faults()});
}

/// The content of a record. Here structs have no padding: their bytes are those of the page.
static_assert(sizeof(hal::Calibration) == kCalibrationBytes);
template <class Content>
const Content* stored(uint8_t record) {
    const uint16_t content = hal::rb85::kCheckpointFirst + kRecordContent;
    return reinterpret_cast<const Content*>(add_wrap(content, widen_u16(record)));
}

/// Drive, steering and mast without power.
[[gnu::noinline]] void motors_off() {
    Parts::Motors::all_off();
    Parts::PpiA::clear_c<hal::rb85::kMastOnBit>();
}

/// Behind whatever gives power to a motor: a TRAP may have come before it.
[[gnu::noinline]] void stop_if_faulty() {
    if (stop_bits() != 0) motors_off();
}

/// An edge for the watchdog.
[[gnu::noinline]] void feed_watchdog() {
    Parts::Watchdog::toggle();
}

}  // namespace
}  // namespace rover

extern "C" {
volatile uint16_t rover_tick_count;  ///< 100 Hz ticks since the end of the boot
volatile uint16_t rover_step_count;  ///< control steps completed
extern const rover::Identity rover_identity;
const rover::Identity rover_identity = rover::kIdentity;
}

namespace rover {
namespace {

const volatile uint8_t* identity_bytes() {
    return reinterpret_cast<const volatile uint8_t*>(&rover_identity);
}

// -- Interrupts ----------------------------------------------------------------------------------

/// 100 Hz. Serial interrupts come through from its first instructions on; the next tick is 30,720 T
/// away.
I85_INTERRUPT(I85_RST_75) void on_tick() {
    Bus::enable_interrupts();
    rover_tick_count = add_wrap(uint16_t{rover_tick_count}, uint16_t{1});
    volatile uint8_t& quiet = battery_area()[battery::kQuietTicks];
    const uint8_t longer = add_wrap(uint8_t{quiet}, uint8_t{1});
    if (longer != 0) quiet = longer;
    if (stop_bits() == 0) hold_servo<Parts>(servos, commands);
    stop_if_faulty();
    ticks_to_count = sub_wrap(ticks_to_count, uint8_t{1});
    if (ticks_to_count != 0) return;
    ticks_to_count = kTicksPerCount;
    const uint8_t forward = Parts::PpiA::read_b();
    read_counters<Parts>(wheels);
    count_wheels(wheels, forward);
}

/// A character has come. One with a wrong frame is counted and not taken; an overrun has cost the
/// one before. Interrupts stay disabled: behind a tick that cuts in, the next character would find
/// this one unfinished.
I85_INTERRUPT(I85_RST_65) void on_receive() {
    const uint8_t errors = bit_and(Parts::Usart::status(), Parts::Usart::kErrors);
    const uint8_t byte = Parts::Usart::read();
    if (errors != 0) {
        Parts::Usart::acknowledge_errors();
        receive_errors = add_wrap(uint16_t{receive_errors}, uint16_t{1});
        if (errors != Parts::Usart::kOverrunError) return;
    }
    received.push(byte);
}

/// The transmitter takes a character. @pre there is one, or the interrupt is masked
I85_INTERRUPT(I85_RST_55) void on_transmit() {
    const bool was_last = to_send.pop([](uint8_t byte) { Parts::Usart::write(byte); });
    if (was_last) Bus::sim(kMaskTransmit);
}

/// Undervoltage or bumper: motors off, latched until the next reset.
I85_INTERRUPT(I85_TRAP) void on_trap() {
    motors_off();
    const bool undervoltage = bit_and(Parts::PpiA::read_b(), hal::rb85::kTrapCauseBit) != 0;
    const uint8_t cause = undervoltage ? kTrapUndervoltage : kTrapBumper;
    trap_faults() = bit_or(uint8_t{trap_faults()}, cause);
    trap_count = add_wrap(uint8_t{trap_count}, uint8_t{1});
}

// -- Boot ----------------------------------------------------------------------------------------

[[gnu::noinline]] void start_parts() {
    Parts::PpiA::set_mode<hal::rb85::kPpiAMode>();
    motors_off();
    Parts::PpiB::set_mode<hal::rb85::kPpiBMode>();
    Parts::PpiB::set_c<hal::rb85::kTrapGateBit>();
    Parts::TimerA::start<hal::rb85::kBaudCounter, Parts::TimerA::Mode::square_wave>(
        hal::rb85::kBaudCount);
    Parts::TimerB::start_all_pulses();
    Parts::TimerC::start_all_pulses();
    Parts::Usart::reset();
}

[[gnu::noinline]] void check_image() {
    const volatile uint8_t* at = identity_bytes() + __builtin_offsetof(Identity, image_size);
    const uint16_t size = *reinterpret_cast<const volatile uint16_t*>(at);
    const auto check_at = static_cast<uint16_t>(reinterpret_cast<uintptr_t>(at) + 2);
    constexpr uint16_t kFirst = loader::kApplicationFirst;
    const auto* const rom = reinterpret_cast<const volatile uint8_t*>(kFirst);
    if (size < kFirst ||
        !rom_is_intact(
            rom, sub_wrap(size, kFirst), sub_wrap(check_at, kFirst), [] { feed_watchdog(); })) {
        set_fault(kFaultRom);
    }
}

/// @param all  else only what the image uses: a warm start is short
[[gnu::noinline]] void check_ram(bool all) {
    const auto wrong = [] { set_fault(kFaultRam); };
    test_address_lines(reinterpret_cast<volatile uint8_t*>(hal::rb85::kRamFirst), 0x4000, wrong);
    uint8_t page = narrow_wrap_u8(uint16_t{hal::rb85::kRamFirst / 256});
    const uint8_t variables_end = narrow_wrap_u8(uint16_t{kRamInUseLast / 256 + 1});
    do {
        if (!all && page == variables_end) page = narrow_wrap_u8(uint16_t{kStackFirst / 256});
        feed_watchdog();
        const uint16_t address = shift_left_wrap<8>(widen_u16(page));
        test_cells(reinterpret_cast<volatile uint8_t*>(address), 0, wrong);
        page = add_wrap(page, uint8_t{1});
    } while (page != hal::rb85::kCheckpointFirst / 256);
}

/// What the last run has left, before it is overwritten.
[[gnu::noinline]] void take_over_status() {
    volatile uint8_t* const area = battery_area();
    const uint8_t mark = area[battery::kMark];
    status.reset_cause = reset_cause(timer_kept_its_mode<Bus>(), mark, area[battery::kQuietTicks]);
    if (mark == static_cast<uint8_t>(RunMark::cold_restart)) drop_checkpoints(area);
    volatile uint16_t& reset_count = reinterpret_cast<volatile uint16_t&>(area[0]);
    status.reset_count = add_wrap(uint16_t{reset_count}, uint16_t{1});
    reset_count = status.reset_count;
    status.last_faults = bit_or(widen_u16(uint8_t{main_faults()}),
                                shift_left_wrap<8>(widen_u16(uint8_t{trap_faults()})));
    main_faults() = 0;
    trap_faults() = 0;
    if (bit_and(Parts::PpiA::read_b(), hal::rb85::kTrapCauseBit) != 0) {
        trap_faults() = kTrapUndervoltage;
    }
    area[battery::kMark] = static_cast<uint8_t>(RunMark::running);
}

/// Controller from calibration record and checkpoint. @return  true: warm
[[gnu::noinline]] bool start_controller() {
    set_initial_values(controller);
    begin_converter(inputs);
    const auto& calibration = *stored<hal::Calibration>(battery::kCalibration);
    bool valid = calibration.version == hal::kCalibrationVersion;
    if (!record_is_valid(battery_area() + battery::kCalibration, kCalibrationBytes)) {
        set_fault(kFaultNoRecord);
        valid = false;
    }
    use_calibration(controller, calibration, valid);
    if (!find_checkpoint(battery_area(), checkpoint)) {
        set_fault(kFaultNoCheckpoint);
        return false;
    }
    controller_resume(controller, *stored<PoseRecord>(checkpoint.slot));
    return true;
}

[[gnu::noinline]] void rover_boot() {
    start_parts();
    take_over_status();
    check_image();
    const bool warm = start_controller();
    status.warm = warm ? 1 : 0;
    check_ram(!warm);
    set_stack_guard(stack_guard());
    Parts::TimerA::start<hal::rb85::kTickCounter, Parts::TimerA::Mode::rate_generator>(
        hal::rb85::kTickCount);
    battery_area()[battery::kQuietTicks] = 0;
    feed_watchdog();
    read_counters<Parts>(wheels);
    for (WheelCount& wheel : wheels) wheel.last = wheel.now;
    ticks_to_count = kTicksPerCount;
    to_send.begin();
    Bus::sim(bit_or(kMaskTransmit, kForgetTick));
    Bus::enable_interrupts();
}

// -- The step ------------------------------------------------------------------------------------

/// Sleeps until an interrupt, with interrupts disabled before: one that waits already ends it. A
/// function of its own, so that nothing comes between the two instructions: EI takes effect behind
/// the next one, and a tick between them would be slept over.
[[gnu::noinline]] void enable_and_halt() {
    Bus::enable_interrupts();
    Bus::halt();
}

/// Sleeps until a step is due.
[[gnu::noinline]] void rover_wait() {
    uint16_t tick;
    for (;;) {
        Bus::disable_interrupts();
        tick = rover_tick_count;
        if (step_is_due(schedule, tick)) break;
        enable_and_halt();
    }
    Bus::enable_interrupts();
    begin_due_step(schedule, tick, [] { set_fault(kFaultStepLate); });
}

[[gnu::noinline]] void rover_acquire() {
    Parts::AnalogInputs::claim();
    read_wheels(rover_tick_count, wheels, inputs);
    inputs.tach_present = Parts::Presence::wheels();
    inputs.detector_bits = Parts::PpiB::read_b();
    read_range<Parts>(inputs);
    read_converter<Parts>(inputs, [] { set_fault(kFaultConverter); });
    Parts::AnalogInputs::release();
}

[[gnu::noinline]] void rover_control() {
    control_step(controller, inputs, commands);
}

/// A TRAP at any place in here leaves the motors off.
[[gnu::noinline]] void rover_apply() {
    drive_motors<Parts::Motors>(commands.drive_percent);
    const uint8_t lasers = bit_and(commands.laser_bits, hal::rb85::kLaserMask);
    Bus::disable_interrupts();
    Parts::PpiA::replace_c<hal::rb85::kLaserMask>(lasers);
    Bus::enable_interrupts();
    stop_if_faulty();
}

/// Is there room for so many bytes? Else a frame is lost.
[[gnu::noinline]] bool room_to_send(uint8_t size) {
    if (to_send.room() >= size) return true;
    status.frames_dropped = add_wrap(status.frames_dropped, uint16_t{1});
    set_fault(kFaultLinkLost);
    return false;
}

struct ToSend {
    [[gnu::noinline]] static void push_all(const volatile uint8_t* from, uint8_t count) {
        to_send.push_all(from, count);
    }
};

[[gnu::noinline]] void queue_frame(DownlinkKind kind, const volatile uint8_t* payload,
                                   uint8_t size) {
    if (!room_to_send(add_wrap(size, kFrameOverhead))) return;
    ToSend sink;
    write_frame<Downlink>(sink, static_cast<uint8_t>(kind), payload, size);
}

/// The estimates as a frame: here a struct has the bytes of the payload.
[[gnu::noinline]] void rover_send() {
    static_assert(kEstimatesAreThePayload);
    queue_frame(DownlinkKind::telemetry,
                reinterpret_cast<const volatile uint8_t*>(&controller.estimates),
                kTelemetryPayloadSize);
}

[[gnu::noinline]] void send_status() {
    status.faults = bit_or(widen_u16(uint8_t{main_faults()}),
                           shift_left_wrap<8>(widen_u16(uint8_t{trap_faults()})));
    status.late_steps = schedule.late_steps;
    status.missed_steps = schedule.missed_steps;
    Bus::disable_interrupts();  // for 64 T: these are the receive handler's
    status.receive_dropped = received.dropped;
    status.receive_errors = receive_errors;
    Bus::enable_interrupts();
    status.received = add_wrap(link_bytes, status.receive_dropped);
    status.frames_refused = uplink.refused;
    status.trap_count = trap_count;
    queue_frame(DownlinkKind::status, reinterpret_cast<const volatile uint8_t*>(&status),
                sizeof status);
}

[[gnu::noinline]] AckResult store_calibration() {
    if (uplink.size() != kCalibrationBytes) return AckResult::wrong_size;
    const uint8_t* const bytes = uplink.payload();
    bool usable = is_valid(*reinterpret_cast<const hal::Calibration*>(bytes));
    const uint8_t* inverted = bytes + 6;
    for (uint8_t left = hal::kAngleChannelCount; left != 0; --left) {
        if (*inverted > 1) usable = false;
        inverted += 5;
    }
    if (!usable) return AckResult::refused;
    write_record(battery_area() + battery::kCalibration, 0, bytes, kCalibrationBytes);
    return AckResult::done;
}

[[gnu::noinline]] AckResult prepare_restart() {
    if (uplink.size() != 1) return AckResult::wrong_size;
    const uint8_t kind = uplink.payload()[0];
    if (kind > static_cast<uint8_t>(RestartKind::loader)) return AckResult::refused;
    RunMark mark = RunMark::warm_restart;
    if (kind == static_cast<uint8_t>(RestartKind::cold)) mark = RunMark::cold_restart;
    if (kind == static_cast<uint8_t>(RestartKind::loader)) mark = RunMark::loader;
    battery_area()[battery::kMark] = static_cast<uint8_t>(mark);
    restarting = true;
    return AckResult::done;
}

[[gnu::noinline]] void answer_frame() {
    const auto type = static_cast<UplinkType>(uplink.type());
    if (type == UplinkType::identity) {
        queue_frame(DownlinkKind::identity, identity_bytes() + sizeof rover_identity.magic,
                    kIdentityPayloadSize);
        return;
    }
    if (type == UplinkType::status) {
        send_status();
        return;
    }
    AckResult result = AckResult::unknown_type;
    if (type == UplinkType::calibration) result = store_calibration();
    if (type == UplinkType::restart) result = prepare_restart();
    // Type and result: in the request the size stands behind the type.
    uplink.frame[3] = static_cast<uint8_t>(result);
    queue_frame(DownlinkKind::acknowledge, uplink.frame + 2, 2);
}

/// Lets the transmitter take what has been queued.
void start_transmitter() {
    Bus::disable_interrupts();
    if (!to_send.empty()) Bus::sim(kOpenAll);
    Bus::enable_interrupts();
}

/// Frames among the bytes of this step.
[[gnu::noinline]] void rover_link() {
    if (received.empty()) uplink.quiet();
    for (uint8_t left = hal::kCommandBytesMax; left != 0 && !received.empty(); --left) {
        link_bytes = add_wrap(link_bytes, uint16_t{1});
        uplink.take(received.pop(), [] { answer_frame(); });
    }
    // Not of one moment: a count that is on its way from 00FFh to 0100h is seen in the next step.
    const uint16_t lost = bit_or(uint16_t{received.dropped}, uint16_t{receive_errors});
    if (lost != 0) set_fault(kFaultLinkLost);
    start_transmitter();
}

[[gnu::noinline]] void rover_checkpoint() {
    add_odometry(controller, controller.map);
    save_checkpoint(battery_area(), checkpoint, controller.map);
}

/// Motors off and no more edges: the watchdog resets, when what is queued has been sent.
void wait_for_reset() {
    Parts::AnalogInputs::claim();
    motors_off();
    for (;;) Bus::halt();
}

}  // namespace
}  // namespace rover

int main() {  // tidy-allow(explicit-width): the language wants int
    using namespace rover;
    rover_boot();
    for (;;) {
        rover_wait();
        rover_acquire();
        rover_control();
        rover_apply();
        rover_send();
        rover_link();
        rover_checkpoint();
        if (!stack_guard_holds(stack_guard())) set_fault(kFaultStack);
        if (restarting) wait_for_reset();
        feed_watchdog();
        battery_area()[battery::kQuietTicks] = 0;
        rover_step_count = add_wrap(uint16_t{rover_step_count}, uint16_t{1});
    }
}
