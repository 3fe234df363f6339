#include "daemons/recorder/CaptureExport.h"

#include "common/capture/PcapWriter.h"
#include "common/platform/PrivateFiles.h"
#include "common/recording/DiskError.h"

#include <QDir>
#include <QRegularExpression>
#include <algorithm>
#include <cstdio>

namespace hermes::recorder {
namespace {

Outcome<void> join(const QString &folder, const QStringList &files, const std::string &draft) {
    PcapWriter writer;
    std::remove(draft.c_str()); // of an export that was cut off, or a link
    Outcome<void> done = writer.open(draft);
    for (const QString &file : files) {
        if (!done)
            break;
        const auto tail = readPcapTail(QFile::encodeName(folder + '/' + file).toStdString(), 0,
                                       [&](const Datagram &datagram) {
                                           if (done)
                                               done = writer.write(datagram);
                                       });
        if (done && !tail)
            done = tail.error();
    }
    done = done ? writer.close() : done;
    QFile file(QString::fromLocal8Bit(draft.c_str()));
    if (done && !(file.open(QIODevice::ReadOnly) && syncToDisk(file.handle())))
        done = file.errorString().toStdString();
    return done;
}

} // namespace

CaptureExport::CaptureExport(const QString &folder)
    : folder_(folder) {
    static const QRegularExpression numbered("^(.+)-[0-9]{4,}\\.pcap$");
    QStringList names = QDir(folder).entryList({"*.pcap"}, QDir::Files);
    std::sort(names.begin(), names.end(), [](const QString &a, const QString &b) {
        return std::pair(a.size(), a) < std::pair(b.size(), b); // 9999 comes before 10000
    });
    for (const QString &name : names) {
        if (const auto match = numbered.match(name); match.hasMatch())
            files_[match.captured(1)].append(name);
    }
}

double CaptureExport::bytes() const {
    double sum = 0;
    for (const auto &[logger, files] : files_)
        for (const QString &file : files)
            sum += double(QFileInfo(folder_ + '/' + file).size());
    return sum;
}

Result<QStringList> CaptureExport::writeInto(const QString &into) const {
    if (files_.empty())
        return Error(ErrorCode::NotReady,
                     folder_ + ": found no capture of a lidar, expected LOGGER-0001.pcap");
    QStringList paths;
    for (const auto &[logger, files] : files_) {
        const QString path = into + '/' + logger + ".pcap";
        const std::string draft = QFile::encodeName(into + "/." + logger + ".pcap.new").toStdString();
        const Outcome<void> done = join(folder_, files, draft);
        if (!done || std::rename(draft.c_str(), QFile::encodeName(path).constData()) != 0) {
            const QString why = done ? qt_error_string() : QString::fromStdString(done.error());
            std::remove(draft.c_str());
            return diskError(path + ": cannot be written: " + why, path);
        }
        paths.append(path);
    }
    return paths;
}

} // namespace hermes::recorder
