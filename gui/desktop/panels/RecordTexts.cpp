#include "gui/desktop/panels/RecordTexts.h"

#include "gui/desktop/widgets/ForeignText.h"
#include "gui/desktop/widgets/Quantities.h"

namespace hermes::desktop {
namespace {

/// As a sidecar has it.
QString reasonText(const QString &ended) {
    return ended == "free space" ? QObject::tr("the disk was full")
           : ended == "failed"   ? QObject::tr("it could not be written")
           : ended == "cut off"  ? QObject::tr("it was cut off")
                                 : shortLine(ended, longestName);
}

QString lossesText(const LoggerWatch &watch) {
    QString text;
    for (const auto &[name, state] : watch.states())
        if (state["recording"].toBool() && sumOf(state["losses"]) > 0) // one packet may count as several
            text += QObject::tr("; %1 lost: %2")
                        .arg(name, shortLine(countsText(state["losses"]).replace('_', ' '), 100));
    return text;
}

/// A line for each logger that did not end it because it was told to.
QStringList reasonsOf(const QString &session, const LoggerWatch &watch, const SessionList &list) {
    std::map<QString, QString> reasons; // by logger
    for (const auto &[logger, state] : watch.states())
        if (state["session"].toString() == session && state["error"].isObject())
            reasons[logger] = shortLine(state["error"].toObject()["message"].toString());
    for (const RecordedSession &one : list.sessions)
        for (const SessionPart &part : one.parts) {
            const QString ended = part.entry["ended"].toString(), &logger = part.member.name;
            const bool isKnown = ended == "failed" && reasons.count(logger); // the error says more
            if (one.id == session && !part.goesOn() && ended != "stopped" && !isKnown)
                reasons[logger] = reasonText(ended);
        }
    QStringList lines;
    for (const auto &[logger, reason] : reasons)
        lines.append(QObject::tr("%1: %2").arg(logger, reason));
    return lines;
}

QString endText(const QString &session, const QString &name, const LoggerWatch &watch) {
    if (!watch.sessions().contains(session))
        return QObject::tr("The recording %1 has ended").arg(name);
    QStringList loggers;
    for (const auto &[logger, state] : watch.states())
        if (state["session"].toString() == session && !state["recording"].toBool())
            loggers.append(logger);
    const QString who = loggers.isEmpty() ? QObject::tr("A logger") : loggers.join(", "); // began anew
    return QObject::tr("%1 no longer records %2").arg(who, name);
}

} // namespace

QString amountText(const LoggerWatch &watch, const SessionList &list) {
    if (watch.members().all.empty())
        return QObject::tr("No logger is connected.");
    if (!watch.isRecording()) {
        QStringList names;
        for (const SessionMember &member : watch.members().all)
            names.append(member.name);
        QString text = QObject::tr("Records with %1.").arg(names.join(", "));
        if (list.unlisted > 0)
            text += ' ' + QObject::tr("%1 older recordings are not listed.").arg(list.unlisted);
        return text;
    }
    QString text = QObject::tr("%1: %2, %3")
                       .arg(shortLine(watch.name(), longestName), durationText(watch.seconds()),
                            sizeText(watch.bytes()));
    if (watch.secondsLeft() > 0)
        text += QObject::tr(", the disk will do for %1").arg(durationText(watch.secondsLeft()));
    return text + lossesText(watch);
}

QString lostText(const LoggerWatch &watch) {
    QStringList lines;
    for (const auto &[name, lost] : watch.lost())
        lines.append((lost.isBack
                          ? QObject::tr("%1 was gone while it recorded %2: what it has of it ends there.")
                          : QObject::tr("%1 was recording %2 and is gone."))
                         .arg(name, shortLine(lost.recording, longestName)));
    return lines.join('\n');
}

QStringList endLines(const QString &session, const QString &name, const LoggerWatch &watch,
                     const SessionList &list) {
    const QStringList reasons = reasonsOf(session, watch, list);
    const QString text = endText(session, shortLine(name, longestName), watch);
    return QStringList(reasons.isEmpty() ? QObject::tr("%1 (not from here).").arg(text) : text + '.') +
           reasons;
}

} // namespace hermes::desktop
