#pragma once

#include "protocol/wire/FieldsOf.h"

#include <QJsonObject>
#include <QStringList>
#include <vector>

namespace hermes {

/// A serial line of a computer, and what was found at its far end.
struct FoundSerial {
    QString path;               ///< that stays the same where there is such a one, as in /dev/hermes
    QString device;             ///< as /dev/ttyUSB0
    QString about;              ///< what the system knows of the adapter, or empty
    QString kind;               ///< one of kinds()
    QString text;               ///< the version of a controller, a sentence, or why there is nothing
    int baud = 0;               ///< at which it was understood; 0: it was not
    std::vector<int> addresses; ///< at which a controller answered
    bool anyAddress = false;    ///< it answers at all of them, as one on USB does
    bool simulated = false;     ///< a process of the supervisor is at the far end
    QString model = {};         ///< of a scanner, as the setting scanner.model has it; empty: it is none

    /// "roboclaw", "arduino" (a base with its text protocol), "vesc", "opencr", "roboteq", "nmea", "scanner"
    /// (a laser scanner of one plane), "talker" (says something else by itself), "other" (answers, but not as
    /// a RoboClaw), "silent", "not_asked" (silent, and nothing was sent to it), "in_use", "failed".
    static QStringList kinds() {
        return controllerKinds() +
               QStringList{"nmea", "scanner", "talker", "other", "silent", "not_asked", "in_use", "failed"};
    }
    static QStringList controllerKinds() { return {"roboclaw", "arduino", "vesc", "opencr", "roboteq"}; }
};

/// A lidar whose packets came.
struct FoundLidar {
    QString address;    ///< whence they came
    QString model = {}; ///< as "VLP-16"; empty: an unknown one
    QString key;  ///< as the setting decode.model of hermes-velodynelogger has it; empty: an unknown one
    int port = 0; ///< at which they came
    double rate_hz = 0;     ///< of data packets
    bool positions = false; ///< it sends position packets, too
    bool simulated = false; ///< it is the simulator of the supervisor
};

/// What setup.find gives.
struct Findings {
    std::vector<FoundSerial> serial;
    std::vector<FoundLidar> lidars;
    QStringList problems;  ///< what could not be looked for
    QStringList restarted; ///< processes that were stopped for the search, and started again
};

/// One setting that is to change.
struct SettingChange {
    QString daemon, path;
    QString now, value; ///< as JSON; empty: the settings file does not say it, so that the default holds
};

/// What setup.propose gives.
struct Proposal {
    QJsonObject settings; ///< by daemons: what changes in the settings of each, or in those of the sample
    std::vector<SettingChange> changes; ///< all that would differ in the settings files
    QStringList notes;                  ///< what a person should know of it
};

/// What setup.apply and setup.undo give.
struct Applied {
    QStringList files;     ///< that were written
    QStringList restarted; ///< processes that ran, or start with the supervisor
    QStringList notes;     ///< what a person should know of it
};

Fields<FoundSerial> fieldsOf(Of<FoundSerial>);
Fields<FoundLidar> fieldsOf(Of<FoundLidar>);
Fields<Findings> fieldsOf(Of<Findings>);
Fields<SettingChange> fieldsOf(Of<SettingChange>);
Fields<Proposal> fieldsOf(Of<Proposal>);
Fields<Applied> fieldsOf(Of<Applied>);

} // namespace hermes
