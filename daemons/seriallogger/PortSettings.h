#pragma once

#include "common/interface/InterfaceUrl.h"
#include "common/schema/Field.h"
#include "common/schema/SchemaValidator.h"
#include "protocol/nmea/SentenceParser.h"

#include <vector>

namespace hermes::seriallogger {

/// One port as the setting `ports` describes it.
struct PortSettings {
    /// What is made of the bytes beside recording them.
    enum class View { None, Lines, Nmea };

    QString name;
    QString url;
    View view = View::Lines;
    nmea::ChecksumRule checksum = nmea::ChecksumRule::Strict;
    double silence_s = 0; ///< after which health calls it stale; 0: never

    static Field field();
    static std::vector<PortSettings> read(const QJsonObject &settings);
    /// What the schema cannot say: each name once, addresses that can be opened.
    static std::vector<SchemaViolation> check(const QJsonObject &settings);
};

} // namespace hermes::seriallogger
