#include "common/recording/RecordingName.h"

#include "common/schema/SchemaValidator.h"

#include <algorithm>

namespace hermes {

namespace {

constexpr int longestRecordingName = 100; // bytes; file systems allow 255, and files add to it

bool isNameCharacter(QChar c) {
    return c.category() != QChar::Other_Control && c != QChar::LineSeparator &&
           c != QChar::ParagraphSeparator && c != '/'; // as NamedFile reads
}

} // namespace

Result<void> checkName(const QString &what, const QString &name) {
    const bool fine = !name.isEmpty() && !name.startsWith('.') &&
                      name.toUtf8().size() <= longestRecordingName &&
                      std::all_of(name.begin(), name.end(), isNameCharacter);
    if (fine)
        return {};
    const QString expected =
        QString("1 to %1 bytes without '/' and control characters, not beginning with a dot")
            .arg(longestRecordingName);
    return invalidParams(
        {{what, name, expected}},
        QString("%1: found \"%2\", expected %3").arg(what, name.left(longestRecordingName), expected));
}

} // namespace hermes
