#pragma once

#include <QFileInfo>
#include <QString>
#include <QtGlobal>

/// A file of the real recordings, in the folder HERMES_DATA names or beside the source tree; empty where it
/// is absent.
inline QString realData(const QString &name) {
    const QString beside =
        qEnvironmentVariable("HERMES_SOURCE", QStringLiteral(".")) + QStringLiteral("/../shared/data/public");
    const QString path = qEnvironmentVariable("HERMES_DATA", beside) + QLatin1Char('/') + name;
    return QFileInfo::exists(path) ? path : QString();
}
