#include "daemons/motorcontrol/LatchFile.h"

#include "common/files/Folder.h"
#include "common/interface/InterfaceUrl.h"
#include "common/recording/FileSync.h"

#include <QFile>
#include <QFileInfo>
#include <QRegularExpression>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

namespace hermes::motorcontrol {
namespace {

constexpr int longestName = 200; // of a file
constexpr qint64 longestReason = 4096;

bool lasts(const QString &address) {
    const auto url = InterfaceUrl::parse(address);
    return url && (url->port != 0 || !url->path.isEmpty());
}

Error failed(const QString &path, const QString &why) {
    return {ErrorCode::InputOutput,
            QString("an emergency stop does not outlive this program: %1: %2").arg(path, why)};
}

} // namespace

void LatchFile::setPlace(const QStringList &listen, const QStringList &lines) {
    path_.clear();
    if (std::none_of(listen.begin(), listen.end(), lasts))
        return;
    QString name = (listen + lines).join('+');
    name.replace(QRegularExpression("[^A-Za-z0-9.+-]+"), "_");
    path_ = stateFolder() + "/estop/" + name.left(longestName);
}

Result<void> LatchFile::mayBeWritten() const {
    if (path_.isEmpty())
        return {};
    const QFileInfo folder(QFileInfo(path_).path());
    if (const auto made = makeFolder(folder.filePath()); !made)
        return failed(folder.filePath(), made.error().message);
    return folder.isWritable() ? Result<void>() : failed(folder.filePath(), "the folder cannot be written");
}

std::optional<QString> LatchFile::read() const {
    QFile file(path_);
    if (path_.isEmpty() || !(file.exists() || QFileInfo(path_).isSymLink()))
        return std::nullopt;
    const QString text =
        file.open(QIODevice::ReadOnly) ? QString::fromUtf8(file.read(longestReason)).simplified() : QString();
    return text.isEmpty() ? "an emergency stop of which nothing is known: " + path_ : text;
}

Result<void> LatchFile::write(const std::optional<QString> &reason) {
    if (path_.isEmpty())
        return {};
    const QString folder = QFileInfo(path_).path();
    if (!reason) {
        if (!QFile::remove(path_) && QFile::exists(path_))
            return Error(ErrorCode::InputOutput,
                         QString("%1 cannot be removed: %2; the next start latches the "
                                 "emergency stop again")
                             .arg(path_, std::strerror(errno)));
        disk_.start([folder] { syncFolder(folder); });
        return {};
    }
    if (const auto may = mayBeWritten(); !may)
        return may;
    const QByteArray text = reason->left(longestReason / 4).toUtf8() + '\n';
    QFile file(path_ + ".new");
    file.remove(); // never through a link
    const bool written = file.open(QIODevice::WriteOnly | QIODevice::NewOnly) &&
                         file.write(text) == text.size() && file.flush();
    file.close();
    if (!written)
        return failed(path_, file.errorString());
    if (std::rename(QFile::encodeName(file.fileName()), QFile::encodeName(path_)) != 0)
        return failed(path_, std::strerror(errno));
    disk_.start([path = path_, folder] {
        syncFile(path);
        syncFolder(folder);
    });
    return {};
}

} // namespace hermes::motorcontrol
