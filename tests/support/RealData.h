#pragma once

#include <QFileInfo>
#include <QString>
#include <QtTest>

/// A file of the real recordings, in the folder HERMES_DATA names or beside the source tree; empty where it
/// is absent.
inline QString realData(const QString &name) {
    const QString beside =
        qEnvironmentVariable("HERMES_SOURCE", QStringLiteral(".")) + QStringLiteral("/../shared/data/public");
    const QString path = qEnvironmentVariable("HERMES_DATA", beside) + QLatin1Char('/') + name;
    return QFileInfo::exists(path) ? path : QString();
}

// REAL_DATA(path, name) skips the test where that file is absent.
#define REAL_DATA(path, name)                                                                                \
    const QString path = realData(name);                                                                     \
    if (path.isEmpty())                                                                                      \
    QSKIP(qPrintable(QStringLiteral("no %1 here; HERMES_DATA names the folder of real recordings").arg(name)))
