#include "gui/desktop/widgets/ForeignText.h"

#include <QObject>
#include <QRegularExpression>
#include <cmath>

namespace hermes::desktop {
namespace {

QString cut(const QString &text, int longest, bool keepsLines) {
    QString shown = text.left(longest);
    for (QChar &c : shown)
        if (!c.isPrint() && !c.isSurrogate() && !(keepsLines && c == '\n'))
            c = ' ';
    if (text.size() > longest)
        shown += QStringLiteral("...");
    return shown;
}

} // namespace

QString shortLine(const QString &text, int longest) {
    return cut(text, longest, false);
}

QString shortText(const QString &text, int longest) {
    return cut(text, longest, true);
}

QString labelText(QString text) {
    return text.replace('&', "&&");
}

QString toolTipOf(const QString &text) {
    if (text.isEmpty())
        return {};
    return "<span style='white-space: pre-wrap'>" + shortText(text).toHtmlEscaped() + "</span>";
}

QString inPlainWords(QString text) {
    static const QRegularExpression address("\\btcp://([^\\s?,;)]+)(?:\\?protocol=\\w+)?");
    text.replace(address, "\\1");
    text.replace("motor.reset_estop releases it", QObject::tr("Release ends it"));
    return text.replace("waits for a new lease", QObject::tr("waits for a new drive"));
}

std::optional<QDateTime> timeOf(double stamp) {
    constexpr double year2200 = 7.26e9;
    if (!(stamp >= 0 && stamp < year2200))
        return std::nullopt;
    return QDateTime::fromMSecsSinceEpoch(qint64(stamp * 1000));
}

QString shortNumber(double value, int decimals) {
    return std::abs(value) < 1e7 ? QString::number(value, 'f', decimals) : QString::number(value, 'g', 3);
}

} // namespace hermes::desktop
