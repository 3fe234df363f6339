#pragma once

#include "common/Result.h"

#include <QStringList>
#include <map>

namespace hermes::recorder {

/// The captures of a session: what lidar loggers have left in its folder, LOGGER-0001.pcap and on.
class CaptureExport {
public:
    explicit CaptureExport(const QString &folder);

    /// Of the files.
    double bytes() const;
    /// Writes LOGGER.pcap into a folder for each logger, all its datagrams with their stamps; a file of this
    /// name there is replaced. What is torn at the end of a file is left out. Gives the paths. NotReady:
    /// there is none; InputOutput.
    Result<QStringList> writeInto(const QString &into) const;

private:
    const QString folder_;
    std::map<QString, QStringList> files_; ///< of each logger, in order
};

} // namespace hermes::recorder
