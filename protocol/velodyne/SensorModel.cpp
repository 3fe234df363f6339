#include "protocol/velodyne/SensorModel.h"
#include "protocol/velodyne/Hdl32e.h"
#include "protocol/velodyne/Vlp16.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hermes::velodyne {

namespace {

std::vector<const SensorModel *> &models() {
    // A new sensor is one line here.
    static std::vector<const SensorModel *> all = {
        &hdl32e,
        &vlp16,
    };
    return all;
}

/// Why a sensor cannot be read, or nothing.
std::string faultOf(const SensorModel &model) {
    const auto isTaken = [&](const SensorModel *other) {
        return other->model == model.model || std::string_view(other->key) == model.key;
    };
    if (model.model == Model::Blank || std::any_of(models().begin(), models().end(), isTaken))
        return "its product byte or its key is another's";
    if (model.lasers < 1 || model.firingsPerBlock < 1 || model.lasers * model.firingsPerBlock > slotsPerBlock)
        return "a block has 32 returns, for whole firings of all lasers";
    if (model.horizonLaser < 0 || model.horizonLaser >= model.lasers)
        return "it has not the laser that is said to look along the horizon";
    if (model.firingPeriod_ns <= 0 || model.firingPeriod_ns > 1000000000 || model.laserPeriod_ns < 0 ||
        model.lasersAtOnce < 1 || !(model.distanceCounts > 0))
        return "a period or a unit is not one";
    const auto isAngle = [](double degrees) { return std::abs(degrees) < 360; };
    if (!std::all_of(model.laser, model.laser + model.lasers, [&](const Laser &laser) {
            return isAngle(laser.elevation_deg) && isAngle(laser.azimuthOffset_deg);
        }))
        return "an angle is not below 360 degrees";
    return {};
}

} // namespace

const std::vector<const SensorModel *> &sensorModels() {
    return models();
}

bool addSensorModel(const SensorModel &model) {
    if (const std::string fault = faultOf(model); !fault.empty())
        throw std::invalid_argument(std::string("lidar model ") + model.name + ": " + fault);
    models().push_back(&model);
    return true;
}

int SensorModel::ring(int number) const {
    return int(std::count_if(laser, laser + lasers, [&](const Laser &other) {
        return other.elevation_deg < laser[number].elevation_deg;
    }));
}

const SensorModel *findSensorModel(Model model) {
    if (model == Model::Blank)
        return &hdl32e;
    for (const SensorModel *known : models())
        if (known->model == model)
            return known;
    return nullptr;
}

Model modelFromText(std::string_view key) {
    for (const SensorModel *known : models())
        if (key == known->key)
            return known->model;
    return Model::Blank;
}

int maxLasers() {
    int most = 0;
    for (const SensorModel *known : models())
        most = std::max(most, known->lasers);
    return most;
}

std::string listSensors(const std::function<std::string(const SensorModel &)> &text, const char *last) {
    std::string list;
    for (const SensorModel *known : models())
        list += (list.empty() ? "" : known == models().back() ? last : ", ") + text(*known);
    return list;
}

std::string sensorNames() {
    return listSensors([](const SensorModel &model) { return model.name; }, " or ");
}

std::string horizonLasers() {
    return listSensors(
        [](const SensorModel &model) { return model.name + (": " + std::to_string(model.horizonLaser)); },
        ", ");
}

std::vector<std::string> modelChoices() {
    std::vector<std::string> choices = {"auto"};
    for (const SensorModel *known : models())
        choices.push_back(known->key);
    return choices;
}

} // namespace hermes::velodyne
