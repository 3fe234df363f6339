#pragma once

#include "common/Result.h"
#include "gui/desktop/model/TopicSampler.h"

namespace hermes::desktop {

/// What is written of one curve.
struct KeptCurve {
    FieldId field;
    QString daemon; ///< its name, with its robot's where there are several
    QString unit;
    Samples samples;
};

/// Writes curves as CSV (RFC 4180): stamp, daemon, topic, field, value, unit. Error: the file cannot be
/// written. May be called from any thread.
Result<void> writeCurves(const QString &file, const std::vector<KeptCurve> &curves);

} // namespace hermes::desktop
