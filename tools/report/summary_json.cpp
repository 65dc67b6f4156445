// summary_json.cpp - the summary for machines.
#include <nlohmann/json.hpp>

#include "tools/report/summary.hpp"
#include "tools/report/write_file.hpp"

namespace report {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Figure& figure) {
    return figure ? Json(*figure) : Json(nullptr);
}

Json json_of(const QuantityFigures& figures) {
    return {{"estimated_mean", json_of(figures.estimated_mean)},
            {"estimated_greatest", json_of(figures.estimated_greatest)},
            {"true_mean", json_of(figures.true_mean)},
            {"true_greatest", json_of(figures.true_greatest)},
            {"rms_error", json_of(figures.rms_error)}};
}

Json json_of(const AlarmFigures& figures) {
    return {{"count", figures.count},
            {"raised_share", figures.raised_share},
            {"first_time_s", json_of(figures.first_time_s)},
            {"first_place_m", json_of(figures.first_place_m)}};
}

}  // namespace

std::string summary_json(const Summary& summary) {
    Json json;
    json["steps"] = summary.step_count;
    json["duration_s"] = summary.duration_s;
    json["vehicle"] = summary.vehicle;
    json["image_identity"] = summary.image_identity;
    json["has_truth"] = summary.has_truth;
    json["has_estimates"] = summary.has_estimates;
    json["distance_m"] = {{"true", json_of(summary.true_distance_m)},
                          {"firmware", json_of(summary.firmware_distance_m)},
                          {"wheels", json_of(summary.wheel_distance_m)}};
    json["position_error"] = {{"firmware_m", json_of(summary.firmware_error_m)},
                              {"wheels_m", json_of(summary.wheel_error_m)},
                              {"firmware_percent", json_of(summary.firmware_error_percent)},
                              {"wheels_percent", json_of(summary.wheel_error_percent)},
                              {"sigma_m", json_of(summary.position_sigma_m)},
                              {"within_sigma_share", json_of(summary.within_sigma_share)}};
    json["slip_overall_percent"] = json_of(summary.slip_overall_percent);
    json["slip_percent"] = json_of(summary.slip_percent);
    json["sinkage_mm"] = json_of(summary.sinkage_mm);
    if (summary.has_estimates) {
        json["alarms"] = {{"slip", json_of(summary.slip_alarm)},
                          {"sinkage", json_of(summary.sinkage_alarm)}};
        json["events"] = {{"cycles", summary.cycle_count},
                          {"lost_lock", summary.lost_lock_count},
                          {"tick_gap", summary.tick_gap_count},
                          {"overspeed", summary.overspeed_count}};
    } else {
        json["alarms"] = nullptr;
        json["events"] = nullptr;
    }
    json["sensors"] = {{"present_share", summary.sensor_present_share},
                       {"missing", summary.sensors_missing},
                       {"intermittent", summary.sensors_intermittent},
                       {"fault_steps", summary.fault_steps}};
    json["estimates"] = {{"available_share", summary.available_share},
                         {"not_available", summary.not_available},
                         {"mode_share", summary.mode_share}};
    json["notes"] = summary.notes;
    json["summary"] = sentences(summary);
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_summary_json(const Summary& summary, const std::filesystem::path& file) {
    write_file(file, summary_json(summary));
}

}  // namespace report
