#pragma once

#include "protocol/wire/FieldsOf.h"

#include <QString>
#include <optional>

namespace hermes {

/// What a GPS receiver told of one moment.
struct FixValues {
    double stamp = 0, mono = 0;
    std::optional<double> time;
    bool valid = false;
    std::optional<double> lat_deg, lon_deg, alt;
    std::optional<int> quality, satellites;
    std::optional<double> hdop, speed, course_deg;
};

/// The topic `fix`.
struct FixMessage {
    QString port;
    FixValues values;
    bool replayed = false;
};

Fields<FixValues> fieldsOf(Of<FixValues>);
Fields<FixMessage> fieldsOf(Of<FixMessage>);

} // namespace hermes
