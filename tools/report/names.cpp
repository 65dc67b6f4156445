#include "tools/report/names.hpp"

namespace report {
namespace {

bool adc_present(const hal::RawInputs& inputs, unsigned index) {
    return inputs.adc_q4_count[index] <= hal::kAdcMaxQ4Count;
}

bool tach_present(const hal::RawInputs& inputs, unsigned index) {
    return ((inputs.tach_present >> index) & 1u) != 0;
}

bool range_present(const hal::RawInputs& inputs, unsigned) {
    return inputs.range_present != 0;
}

unsigned adc_index(hal::AdcChannel channel) {
    return static_cast<unsigned>(channel);
}

}  // namespace

const std::vector<Sensor>& sensors() {
    using hal::AdcChannel;
    static const std::vector<Sensor> all = {
        {"bogie_left", "left bogie potentiometer", adc_present, adc_index(AdcChannel::bogie_left)},
        {"bogie_right", "right bogie potentiometer", adc_present,
         adc_index(AdcChannel::bogie_right)},
        {"differential", "differential potentiometer", adc_present,
         adc_index(AdcChannel::differential)},
        {"pitch", "pitch inclinometer", adc_present, adc_index(AdcChannel::pitch)},
        {"roll", "roll inclinometer", adc_present, adc_index(AdcChannel::roll)},
        {"tach_front_left", "front left tachometer", tach_present, 0},
        {"tach_front_right", "front right tachometer", tach_present, 1},
        {"tach_middle_left", "middle left tachometer", tach_present, 2},
        {"tach_middle_right", "middle right tachometer", tach_present, 3},
        {"tach_rear_left", "rear left tachometer", tach_present, 4},
        {"tach_rear_right", "rear right tachometer", tach_present, 5},
        {"range", "range module", range_present, 0},
    };
    return all;
}

}  // namespace report
