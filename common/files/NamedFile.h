#pragma once

#include "common/Result.h"

#include <QByteArray>
#include <QFile>
#include <QStringList>

namespace hermes {

/// Files that clients locate: regular files below folders that the settings
/// allow, never a device, a pipe or a socket, whatever links lead to; without waiting for anybody, and never
/// more than a limit. Links are resolved first, and what they lead to has to be below the folders, too; then
/// the file is opened without following any, so that nobody can change them meanwhile. Errors: InputOutput
/// with data.path. A path that is relative begins in the working directory; errors tell the absolute one.

/// The path as answers tell it: absolute.
QString absolutePath(const QString &path);

/// The whole file.
Result<QByteArray> readNamedFile(const QString &path, const QStringList &folders, qint64 maxBytes);

/// The path without links of a file that could be opened so, of leastBytes or more: for readers that open it
/// themselves, and follow links that somebody puts there meanwhile.
Result<QString> findNamedFile(const QString &path, const QStringList &folders, qint64 leastBytes = 1);

/// Writes the file so that it is on the disk as a whole, or not at all. replace: a regular file that is
/// there.
Result<void> writeNamedFile(const QString &path, const QStringList &folders, const QByteArray &bytes,
                            bool replace);

/// Whether a file can be put there as one of its own kind: what is there, if anything, is a regular file,
/// whatever links lead to. For writers that follow links, and rename over what they lead to.
Result<void> checkReplaceable(const QString &path);

/// Opens a file that a program keeps for itself, to read and to change it; make: it is made where it is
/// missing. Refused is what is no regular file, or is reached by a link: it may be somebody else's. Links
/// among the folders of the path are followed.
Result<void> openOwnFile(QFile &file, const QString &path, bool make = false);

} // namespace hermes
