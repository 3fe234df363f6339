#include "gui/desktop/panels/RecordPanel.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/MessageLabel.h"

#include <QDateTime>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLineEdit>
#include <QLocale>
#include <QPushButton>
#include <QTreeWidget>
#include <QVBoxLayout>

namespace hermes::desktop {
namespace {

constexpr int longestName = 60;

QString bytesText(double bytes) {
    const char *const units[]{"B", "kB", "MB", "GB", "TB"};
    int unit = 0;
    while (bytes >= 1000 && unit < 4) {
        bytes /= 1000;
        ++unit;
    }
    return shortNumber(bytes, unit == 0 ? 0 : 1) + ' ' + units[unit];
}

QString timeText(double seconds) {
    constexpr double century_s = 3.2e9;
    if (!(seconds >= 0 && seconds < century_s))
        return RecordPanel::tr("%1 s").arg(shortNumber(seconds, 0));
    const qint64 s = qint64(seconds);
    if (s >= 3600)
        return RecordPanel::tr("%1 h %2 min").arg(s / 3600).arg(s / 60 % 60);
    return s >= 60 ? RecordPanel::tr("%1 min %2 s").arg(s / 60).arg(s % 60) : RecordPanel::tr("%1 s").arg(s);
}

QString startText(double stamp) {
    const auto start = timeOf(stamp);
    return start ? QLocale().toString(*start, QLocale::ShortFormat)
                 : RecordPanel::tr("at an impossible time: %1").arg(stamp);
}

} // namespace

RecordPanel::RecordPanel(Fleet &fleet, QWidget *parent)
    : QWidget(parent)
    , watch_(fleet)
    , name_(new QLineEdit("run1"))
    , mark_(new QLineEdit)
    , record_(new QPushButton)
    , addMark_(new QPushButton(tr("Mark")))
    , replay_(new QPushButton(theme::icon("start"), tr("Repla&y")))
    , live_(new QPushButton(tr("&Live")))
    , amount_(new PlainLabel)
    , message_(new MessageLabel)
    , sessions_(new QTreeWidget) {
    name_->setObjectName("name");
    name_->setToolTip(tr("Of the folder in which all loggers record"));
    record_->setObjectName("record");
    replay_->setObjectName("replay");
    replay_->setToolTip(tr("Plays the chosen recording through the same topics"));
    live_->setObjectName("live");
    live_->setToolTip(tr("Ends the replay"));
    amount_->setObjectName("amount");
    amount_->setWordWrap(true);
    amount_->setMinimumWidth(1);
    sessions_->setObjectName("sessions");
    sessions_->setAccessibleName(tr("What was recorded"));
    sessions_->setHeaderLabels({tr("Recording"), tr("Size")});
    sessions_->header()->setStretchLastSection(false);
    sessions_->header()->setSectionResizeMode(0, QHeaderView::Stretch);
    sessions_->header()->setSectionResizeMode(1, QHeaderView::ResizeToContents);
    sessions_->setRootIsDecorated(false);

    mark_->setObjectName("markText");
    mark_->setPlaceholderText(tr("What to remember of this moment"));
    addMark_->setObjectName("mark");
    layOut();

    connect(record_, &QPushButton::clicked, this, [this] { watch_.isRecording() ? stop() : start(); });
    connect(name_, &QLineEdit::returnPressed, record_, &QPushButton::click);
    connect(addMark_, &QPushButton::clicked, this, &RecordPanel::mark);
    connect(mark_, &QLineEdit::returnPressed, addMark_, &QPushButton::click);
    connect(replay_, &QPushButton::clicked, this, &RecordPanel::play);
    connect(live_, &QPushButton::clicked, &player_, &SessionPlayer::end);
    connect(sessions_, &QTreeWidget::currentItemChanged, this, &RecordPanel::update);
    connect(&watch_, &LoggerWatch::changed, this, &RecordPanel::update);
    connect(&watch_, &LoggerWatch::membersChanged, this, &RecordPanel::list);
    connect(&player_, &SessionPlayer::ended, this, [this](const Result<void> &result) {
        message_->tell(result ? tr("The replay has ended; everything is live.") : result.error().message,
                       !result);
        update();
    });
    list();
    update();
}

void RecordPanel::layOut() {
    auto *const top = new QHBoxLayout;
    top->addWidget(name_, 1);
    top->addWidget(record_);
    auto *const middle = new QHBoxLayout;
    middle->addWidget(mark_, 1);
    middle->addWidget(addMark_);
    auto *const bottom = new QHBoxLayout;
    bottom->addWidget(replay_);
    bottom->addWidget(live_);
    auto *const layout = new QVBoxLayout(this);
    layout->addLayout(top);
    layout->addLayout(middle);
    layout->addWidget(amount_);
    layout->addWidget(sessions_, 1);
    layout->addLayout(bottom);
    layout->addWidget(message_);
}

/// With the loggers of this moment.
SessionRecorder &RecordPanel::recorder() {
    recorder_.setMembers(watch_.members());
    return recorder_;
}

void RecordPanel::start() {
    const QString name = name_->text().trimmed();
    recorder().start(name, [this, name](const Result<SessionReplies> &replies) {
        message_->tell(replies ? tr("Recording %1.").arg(name) : replies.error().message, !replies);
        watch_.poll();
        list();
    });
}

void RecordPanel::stop() {
    recorder().stop([this](const Result<SessionRecorder::Stopped> &stopped) {
        const QStringList problems = stopped ? stopped->problems : QStringList(stopped.error().message);
        message_->tell(problems.isEmpty() ? tr("Stopped, nothing missing.") : problems.join('\n'),
                       !problems.isEmpty());
        watch_.poll();
        list();
    });
}

void RecordPanel::mark() {
    const QString text = mark_->text().trimmed();
    recorder().mark(text, [this, text](const Result<SessionReplies> &replies) {
        message_->tell(replies ? tr("Marked: %1").arg(text) : replies.error().message, !replies);
        if (replies)
            mark_->clear();
    });
}

void RecordPanel::list() {
    recorder().list(mostRecordings, [this](const SessionList &found) {
        list_ = found;
        update();
    });
}

void RecordPanel::play() {
    const int row = sessions_->indexOfTopLevelItem(sessions_->currentItem());
    if (row < 0 || row >= int(list_.sessions.size()))
        return;
    const RecordedSession &session = list_.sessions[std::size_t(row)];
    QStringList lines = session.absent();
    lines.prepend(tr("Replaying %1.").arg(session.name));
    message_->tell(lines.join('\n'), lines.size() > 1);
    player_.play(session, {});
    update();
}

void RecordPanel::update() {
    const bool isRecording = watch_.isRecording();
    record_->setText(isRecording ? tr("S&top") : tr("Re&cord"));
    record_->setIcon(theme::icon(isRecording ? "stop" : "record"));
    record_->setEnabled(!watch_.members().all.empty() && (isRecording || !name_->text().trimmed().isEmpty()));
    name_->setEnabled(!isRecording);
    mark_->setVisible(watch_.marks());
    addMark_->setVisible(watch_.marks());
    showAmount();
    showSessions();
    replay_->setEnabled(sessions_->currentItem() && !isRecording);
    live_->setEnabled(player_.isPlaying());
}

void RecordPanel::showAmount() {
    const QStringList silent = watch_.silent();
    amount_->setEnabled(silent.isEmpty()); // else it is old
    amount_->setText(silent.isEmpty()
                         ? amountText()
                         : tr("%1 does not answer; last known: %2").arg(silent.join(", "), amountText()));
}

QString RecordPanel::amountText() const {
    if (watch_.members().all.empty())
        return tr("No logger is connected.");
    if (!watch_.isRecording()) {
        QStringList names;
        for (const SessionMember &member : watch_.members().all)
            names.append(member.name);
        QString text = tr("Records with %1.").arg(names.join(", "));
        if (list_.unlisted > 0)
            text += ' ' + tr("%1 older recordings are not listed.").arg(list_.unlisted);
        return text;
    }
    QString text = tr("%1: %2, %3")
                       .arg(shortLine(watch_.name(), longestName), timeText(watch_.seconds()),
                            bytesText(watch_.bytes()));
    if (watch_.secondsLeft() > 0)
        text += tr(", the disk will do for %1").arg(timeText(watch_.secondsLeft()));
    for (const auto &[name, state] : watch_.states())
        if (const double lost = sumOf(state["losses"]); lost > 0)
            text += tr("; %1 misses %2").arg(name).arg(lost);
    return text;
}

void RecordPanel::showSessions() {
    const QSignalBlocker silence(sessions_); // update() is what fills it
    const int count = int(list_.sessions.size());
    while (sessions_->topLevelItemCount() > count)
        delete sessions_->takeTopLevelItem(sessions_->topLevelItemCount() - 1);
    while (sessions_->topLevelItemCount() < count)
        sessions_->addTopLevelItem(new QTreeWidgetItem);
    for (int i = 0; i < count; ++i) {
        const RecordedSession &session = list_.sessions[std::size_t(i)];
        QStringList lines{startText(session.start)};
        for (const SessionPart &part : session.parts)
            lines.append(tr("%1: %2, %3")
                             .arg(part.member.name, countsText(part.entry["counts"]),
                                  part.fault().isEmpty() ? tr("complete") : part.fault()));
        const bool isComplete = session.faults().isEmpty();
        QTreeWidgetItem *const item = sessions_->topLevelItem(i);
        item->setText(0, shortLine(session.name, longestName));
        item->setText(1, bytesText(session.bytes()));
        item->setIcon(0, theme::icon(isComplete         ? Condition::Ready
                                     : session.goesOn() ? Condition::Busy
                                                        : Condition::Warning));
        item->setToolTip(0, toolTipOf(lines.join('\n')));
    }
}

} // namespace hermes::desktop
