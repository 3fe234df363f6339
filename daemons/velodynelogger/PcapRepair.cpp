// How the Velodyne logger mends a recording that was cut off.
#include "common/files/NamedFile.h"
#include "common/recording/DiskError.h"
#include "daemons/velodynelogger/Recorder.h"

#include <QDir>
#include <QRegularExpression>

#include <algorithm>
#include <vector>

namespace hermes::velodynelogger {

namespace {

/// Names of the files in order, PREFIX-10000 after PREFIX-9999.
std::vector<QString> captureFiles(const RecordingPlan &plan) {
    const QRegularExpression form('^' + QRegularExpression::escape(plan.prefix) + "-[0-9]{4,}\\.pcap$");
    std::vector<QString> names;
    for (const QString &name : QDir(plan.folder).entryList(QDir::Files, QDir::Name))
        if (form.match(name).hasMatch())
            names.push_back(name);
    std::stable_sort(names.begin(), names.end(),
                     [](const QString &a, const QString &b) { return a.size() < b.size(); });
    return names;
}

QJsonObject entryOf(const QJsonArray &files, const QString &name) {
    for (const QJsonValue &file : files)
        if (file.toObject().value("name") == name)
            return file.toObject();
    return QJsonObject{{"name", name}};
}

void add(QJsonObject &object, const char *member, double count) {
    object.insert(member, object.value(member).toDouble() + count);
}

/// Repairs one file and completes its entry; false when nothing is in it and it has been removed.
Result<bool> repairFile(const QString &path, QJsonObject &entry, PacketAccount &account) {
    QFile file;
    if (const Result<void> opened = openOwnFile(file, path); !opened)
        return opened.error();
    const double known = entry.value("bytes").toDouble();
    const auto sink = [&account](const Datagram &datagram) {
        account.add(datagram);
        return true;
    };
    const Outcome<PcapTail> read =
        readPcapTail(path.toStdString(), std::uint64_t(std::max(0.0, known)), sink);
    if (!read)
        return diskError(QString::fromStdString(read.error()), path);
    const PcapTail &tail = *read;
    if (tail.wholeBytes == 0) { // killed as it began the file
        if (!QFile::remove(path))
            return diskError(path + ": cannot be removed: " + qt_error_string(), path);
        return false;
    }
    if (tail.wholeBytes < tail.fileBytes && !file.resize(qint64(tail.wholeBytes)))
        return diskError(path + ": cannot be cut to whole packets: " + file.errorString(), path);
    const bool anew = double(tail.fileBytes) < known; // a power cut took what the sidecar knew
    entry.insert("bytes", double(tail.wholeBytes));
    entry.insert("packets", (anew ? 0 : entry.value("packets").toDouble()) + double(tail.packets));
    if (tail.packets > 0 && (anew || entry.value("packets").toDouble() == double(tail.packets)))
        entry.insert("start", double(tail.first_ns) * 1e-9);
    if (tail.packets > 0)
        entry.insert("end", double(tail.last_ns) * 1e-9);
    return true;
}

} // namespace

Result<void> Recorder::repair(const RecordingPlan &plan, QJsonObject &sidecar) {
    PacketAccount account; // of what the sidecar does not know
    QJsonArray files;
    double bytes = 0, packets = 0;
    for (const QString &name : captureFiles(plan)) {
        QJsonObject entry = entryOf(sidecar.value("files").toArray(), name);
        const Result<bool> kept = repairFile(plan.folder + '/' + name, entry, account);
        if (!kept)
            return kept.error();
        if (!*kept)
            continue;
        bytes += entry.value("bytes").toDouble();
        packets += entry.value("packets").toDouble();
        if (entry.value("packets").toDouble() > 0)
            sidecar.insert("end", entry.value("end"));
        files.append(entry);
    }
    QJsonObject counts = sidecar.value("counts").toObject(), losses = sidecar.value("losses").toObject();
    counts.insert("packets", packets);
    add(counts, "data", double(account.counts().data));
    add(counts, "position", double(account.counts().position));
    add(counts, "other", double(account.counts().other));
    add(losses, "missing", double(account.counts().missing));
    sidecar.insert("files", files);
    sidecar.insert("bytes", bytes);
    sidecar.insert("counts", counts);
    sidecar.insert("losses", losses);
    return {};
}

} // namespace hermes::velodynelogger
