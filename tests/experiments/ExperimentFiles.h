#pragma once

#include <QMap>
#include <QVector>

/// Runs hermes-vector experiment to its end; its exit code, -1 where it crashed. `error` takes what it said.
inline int runExperiment(const QStringList &arguments, QByteArray *error = nullptr) {
    QProcess process;
    process.start(qEnvironmentVariable("HERMES_BIN") + "/hermes-experiments",
                  QStringList("experiment") + arguments);
    process.waitForFinished(60000);
    if (error)
        *error = process.readAllStandardError();
    return process.exitStatus() == QProcess::NormalExit ? process.exitCode() : -1;
}

/// Whether plots are drawn here.
inline bool hasMatplotlib() {
    return QProcess::execute("/usr/bin/python3", {"-c", "import matplotlib"}) == 0;
}

inline QList<QByteArray> lines(const QString &path) {
    return contentOf(path).trimmed().split('\n');
}

/// The rows of a CSV file by the names of its columns.
inline QVector<QMap<QByteArray, QByteArray>> table(const QString &path) {
    QVector<QMap<QByteArray, QByteArray>> rows;
    const QList<QByteArray> text = lines(path), names = text.value(0).split(',');
    for (const QByteArray &line : text.mid(1)) {
        const QList<QByteArray> fields = line.split(',');
        rows.resize(rows.size() + 1);
        for (int i = 0; i < names.size(); ++i)
            rows.last()[names[i]] = fields.value(i);
    }
    return rows;
}
