#pragma once

#include "common/settings/SettingsTable.h"
#include "daemons/simulator/Simulation.h"

namespace hermes::simulator {

/// The settings of hermes-simulator as its parts use them.
struct SimulatorSettings : SettingsTable {
    Simulation::Options simulation;
    QString world;
    bool autostart = false;
    QString lidarHost = "127.0.0.1";
    std::uint16_t lidarPort = velodyne::dataPort, positionPort = velodyne::positionPort;
    QString link, link2, gpsLink, scannerLink; ///< to pseudo-terminals; empty: none
    std::uint16_t scannerPort = 0;             ///< 0: a pseudo-terminal instead
    QString scannerModel = "none";
    QString firmware = "4.2.8"; ///< of both motor controllers
    QString layout = "mecanum";
    QString motorsKind = "roboclaw";

    SimulatorSettings();
    /// From settings that it has declared.
    explicit SimulatorSettings(const QJsonObject &settings);

private:
    void addMotors();
    void addGps();
    void addScanner();
};

} // namespace hermes::simulator
