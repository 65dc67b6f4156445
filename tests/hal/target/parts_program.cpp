// parts_program.cpp - the drivers on the real processor: one function a job, called by the host's
// wish in `wish`. Compiled by i85cc.
#include "hal/board/rb85_parts.hpp"
#include "hal/target/i8085.hpp"

using Parts = hal::Rb85Parts<hal::I8085>;
namespace rb85 = hal::rb85;

extern "C" {

volatile uint8_t wish;  // the host writes it, main clears it
uint8_t argument;
uint8_t duties[6];
uint8_t signs;
uint16_t result;
uint16_t sums[16];
uint16_t pulses[6];
hal::RangeFrame frame;
uint8_t channels;        // that the sums take: the first ones
volatile uint8_t servo;  // channel that the tick converts, behind those of the sums; 0: none
volatile uint8_t servo_result;
volatile uint16_t servo_results;
volatile uint16_t ticks;
uint8_t received;
volatile uint8_t received_status;

[[gnu::noinline]] void start_ports() {
    Parts::PpiA::set_mode<rb85::kPpiAMode>();
    Parts::PpiB::set_mode<rb85::kPpiBMode>();
}
[[gnu::noinline]] void start_timers() {
    using A = Parts::TimerA;
    A::start<rb85::kTickCounter, A::Mode::rate_generator>(rb85::kTickCount);
    A::start<rb85::kBaudCounter, A::Mode::square_wave>(rb85::kBaudCount);
    Parts::TimerB::start_pulses<0>();
    Parts::TimerB::start_pulses<1>();
    Parts::TimerB::start_pulses<2>();
    Parts::TimerC::start_pulses<0>();
    Parts::TimerC::start_pulses<1>();
    Parts::TimerC::start_pulses<2>();
}
[[gnu::noinline]] void usart_reset() {
    Parts::Usart::reset();
}
[[gnu::noinline]] uint16_t sum_of_16(uint8_t channel) {
    uint16_t sum;
    (void)Parts::AnalogInputs::sum_of_16(channel, sum);
    return sum;
}
[[gnu::noinline]] void servo_turn() {
    const uint8_t selected = Parts::AnalogInputs::selected();
    if (selected < channels) return;
    if (selected == servo) {
        servo_result = Parts::AnalogInputs::upper_bits();
        servo_results = servo_results + 1;
    }
    Parts::AnalogInputs::start(servo);
}
[[gnu::noinline]] void read_pulses() {
    Parts::TimerB::latch_pulses();
    Parts::TimerC::latch_pulses();
    pulses[0] = Parts::TimerB::pulses<0>();
    pulses[1] = Parts::TimerB::pulses<1>();
    pulses[2] = Parts::TimerB::pulses<2>();
    pulses[3] = Parts::TimerC::pulses<0>();
    pulses[4] = Parts::TimerC::pulses<1>();
    pulses[5] = Parts::TimerC::pulses<2>();
}
[[gnu::noinline]] uint8_t range_read() {
    return static_cast<uint8_t>(Parts::Range::read(frame));
}
[[gnu::noinline]] void drive() {
    Parts::Motors::drive(duties, signs);
}
[[gnu::noinline]] void steer() {
    const uint8_t steering[4] = {duties[0], duties[1], duties[2], duties[3]};
    const uint8_t none[4] = {};
    Parts::Motors::steer(none, signs);  // motors turn round without power
    Parts::Motors::steer(steering, signs);
}
[[gnu::noinline]] void all_off() {
    Parts::Motors::all_off();
}
[[gnu::noinline]] void toggle() {
    Parts::Watchdog::toggle();
}
[[gnu::noinline]] uint8_t wheels() {
    return Parts::Presence::wheels();
}

I85_INTERRUPT(I85_RST_75) void tick() {
    ticks = ticks + 1;
    if (servo != 0) servo_turn();
}

int main() {
    channels = 16;
    start_ports();
    start_timers();
    usart_reset();
    all_off();
    hal::I8085::sim(0x1B);  // RST 7.5 alone, and none from before
    hal::I8085::enable_interrupts();
    for (;;) {
        switch (wish) {
            case 1:
                Parts::AnalogInputs::claim();
                read_pulses();  // the tick's conversion ends meanwhile
                for (uint8_t channel = 0; channel < channels; ++channel)
                    sums[channel] = sum_of_16(channel);
                Parts::AnalogInputs::release();
                break;
            case 3:
                read_pulses();
                break;
            case 4:
                result = range_read();
                break;
            case 5:
                drive();
                steer();
                break;
            case 2:
                servo_turn();
                break;
            case 6:
                all_off();
                break;
            case 7:
                result = wheels();
                break;
            case 8:
                received_status = Parts::Usart::status();
                received = Parts::Usart::read();
                Parts::Usart::acknowledge_errors();
                Parts::Usart::write(argument);
                break;
            case 9:
                usart_reset();
                break;
            default:
                break;
        }
        wish = 0;
        toggle();
        hal::I8085::halt();
    }
}

}  // extern "C"
