#include "gui/desktop/panels/RecordPanel.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/panels/RecordTexts.h"
#include "gui/desktop/panels/ReplayBar.h"
#include "gui/desktop/panels/SessionTable.h"
#include "gui/desktop/widgets/MessageLabel.h"

#include <QAction>
#include <QHBoxLayout>
#include <QLineEdit>
#include <QPushButton>
#include <QVBoxLayout>

#include <algorithm>

namespace hermes::desktop {
RecordPanel::RecordPanel(Fleet &fleet, QWidget *parent)
    : QWidget(parent)
    , fleet_(fleet)
    , watch_(fleet)
    , stops_(fleet, watch_)
    , name_(new QLineEdit("run1"))
    , mark_(new QLineEdit)
    , record_(new QPushButton)
    , addMark_(new QPushButton(tr("Mark")))
    , replay_(new QPushButton(theme::icon("start"), tr("Repla&y")))
    , live_(new QPushButton(tr("&Live")))
    , takeMark_(new QAction(tr("Mark this moment of the recording"), this))
    , amount_(new PlainLabel)
    , lost_(new PlainLabel)
    , message_(new MessageLabel)
    , sessions_(new SessionTable)
    , bar_(new ReplayBar(player_)) {
    nameAll();
    layOut();
    connectAll();
    connect(&fleet, &Fleet::robotChosen, this, [this] { // what was recorded there is not here
        if (!name_->isModified())
            name_->setText("run1"); // the next free one of this robot is proposed
        list_ = {};
        ends_.clear();
        sessions_->tell(list_);
        message_->hide();
        list();
        update();
    });
    list();
    update();
}

void RecordPanel::nameAll() {
    name_->setObjectName("name");
    name_->setToolTip(tr("Of the folder in which all loggers record"));
    record_->setObjectName("record");
    replay_->setObjectName("replay");
    replay_->setToolTip(tr("Plays the chosen recording through the same topics (double click)"));
    live_->setObjectName("live");
    live_->setToolTip(tr("Ends the replay"));
    amount_->setObjectName("amount");
    amount_->setWordWrap(true);
    amount_->setMinimumSize(1, 2 * fontMetrics().lineSpacing()); // else the list moves under the mouse
    amount_->setAlignment(Qt::AlignTop);
    lost_->setObjectName("lost");
    lost_->setWordWrap(true);
    lost_->setMinimumWidth(1);
    QPalette fault;
    fault.setColor(QPalette::WindowText, theme::colour(Condition::Fault));
    lost_->setPalette(fault);
    lost_->hide();
    mark_->setObjectName("markText");
    mark_->setPlaceholderText(tr("What to remember of this moment"));
    mark_->setToolTip(tr("Without a text the mark gets a number"));
    mark_->setMaxLength(1000);
    addMark_->setObjectName("mark");
    takeMark_->setObjectName("takeMark");
    takeMark_->setShortcut(Qt::CTRL + Qt::Key_M);
    takeMark_->setShortcutContext(Qt::ApplicationShortcut); // floating panels, too
    addMark_->setToolTip(tr("Puts a mark into the recording (%1)").arg(takeMark_->shortcut().toString()));
    addAction(takeMark_);
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
    layout->addWidget(sessions_, 1); // gives its room to what is told below it: no button moves
    layout->addWidget(lost_);
    layout->addWidget(message_);
    layout->addWidget(bar_);
    layout->addLayout(bottom);
    for (QWidget *const widget : std::initializer_list<QWidget *>{mark_, addMark_}) {
        QSizePolicy policy = widget->sizePolicy();
        policy.setRetainSizeWhenHidden(true);
        widget->setSizePolicy(policy);
    }
    record_->setIcon(theme::icon("stop")); // the wider of its two texts
    for (const QString &text : {tr("S&top"), tr("Re&cord")}) {
        record_->setText(text);
        record_->setMinimumWidth(std::max(record_->minimumWidth(), record_->sizeHint().width()));
    }
}

void RecordPanel::connectAll() {
    connect(record_, &QPushButton::clicked, this, [this] { watch_.isRecording() ? stop() : start(); });
    connect(name_, &QLineEdit::returnPressed, record_, &QPushButton::click);
    connect(name_, &QLineEdit::textChanged, this, &RecordPanel::update);
    connect(addMark_, &QPushButton::clicked, this, &RecordPanel::mark);
    connect(mark_, &QLineEdit::returnPressed, addMark_, &QPushButton::click);
    connect(takeMark_, &QAction::triggered, this, &RecordPanel::mark);
    connect(replay_, &QPushButton::clicked, this, &RecordPanel::play);
    connect(live_, &QPushButton::clicked, this,
            [this] { isOwnShown() || !isReplaying_ ? player_.end() : Q_EMIT liveWanted(); });
    connect(sessions_, &SessionTable::currentItemChanged, this, &RecordPanel::update);
    connect(sessions_, &SessionTable::itemActivated, this, &RecordPanel::play);
    connect(&watch_, &LoggerWatch::changed, this, [this] {
        if (std::exchange(listed_, watch_.sessions()) != watch_.sessions()) // whoever began or ended one
            list();
        update();
    });
    connect(&watch_, &LoggerWatch::ended, this, &RecordPanel::takeEnd);
    connect(&watch_, &LoggerWatch::membersChanged, this, &RecordPanel::list);
    connect(&stops_, &RecordingStops::changed, this, &RecordPanel::update);
    connect(&stops_, &RecordingStops::ended, this, &RecordPanel::showStopped);
    connect(&player_, &SessionPlayer::ended, this, [this](const Result<void> &result) {
        const QString text =
            result ? tr("The replay has ended; everything is live.") : result.error().message;
        const QString here = fleet_.robot() ? fleet_.titleOf(*fleet_.robot()) : QString();
        message_->tell(playedBy_ == here ? text : tr("%1: %2").arg(playedBy_, text), !result);
        update();
    });
}

/// The chosen robot shows what is played from here.
bool RecordPanel::isOwnShown() const {
    const auto &all = watch_.members().all;
    return player_.isPlaying() && std::any_of(all.begin(), all.end(), [this](const SessionMember &member) {
               return member.client && player_.plays(*member.client);
           });
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
        begun_ = replies ? message_->text() : QString();
        if (replies) {
            watch_.forgetLost();
            name_->setModified(false); // the next one is proposed
        } else {
            stops_.expect(recorder_.takenBack(), recorder_.mayRecord()); // whose link broke may have begun
        }
        watch_.poll();
        list();
    });
}

void RecordPanel::stop() {
    stops_.begin();
    update();
}

/// Unless it was ended from here.
void RecordPanel::takeEnd(const QString &session, const QString &name) {
    const RecordingStop *const stop = stops_.chosen();
    if ((stop && stop->ends(session)) || recorder_.takenBack() == session)
        return;
    ends_[session] = name;
    list();
}

/// As the list has them now.
void RecordPanel::showEnds() {
    QStringList lines;
    const QMap<QString, QString> ends = std::exchange(ends_, {});
    for (auto end = ends.begin(); end != ends.end(); ++end)
        lines += endLines(end.key(), end.value(), watch_, list_);
    if (!lines.isEmpty())
        message_->tell(lines.join('\n'), lines.size() > ends.size()); // with reasons
}

void RecordPanel::showStopped(const QString &text, bool isError, bool isChosen) {
    message_->tell(text, isError);
    if (!isChosen)
        return;
    sessions_->setCurrentItem(nullptr); // the latest is chosen
    watch_.poll();
    list();
}

void RecordPanel::mark() {
    if (!watch_.marks())
        return message_->tell(
            watch_.isRecording()
                ? tr("No mark was taken: none of the loggers that record takes marks, as the "
                     "serial logger does.")
            : fleet_.robot()
                ? tr("No mark was taken: %1 records nothing.").arg(fleet_.titleOf(*fleet_.robot()))
                : tr("No mark was taken: there is no robot."),
            true);
    const QString typed = mark_->text(), text = markText();
    recorder_.setMembers(watch_.markers()); // it waits for no others
    recorder_.mark(text, [this, typed, text](const Result<SessionReplies> &replies) {
        message_->tell(replies ? tr("Marked: %1").arg(text) : replies.error().message, !replies);
        if (replies && mark_->text() == typed)
            mark_->clear();
    });
}

/// As typed, or a number.
QString RecordPanel::markText() {
    if (markedIn_ != watch_.sessions())
        markNumber_ = 0;
    markedIn_ = watch_.sessions();
    markNumber_ = std::max(markNumber_, watch_.markCount()) + 1;
    const QString typed = mark_->text().trimmed();
    return typed.isEmpty() ? tr("mark %1").arg(markNumber_) : typed;
}

void RecordPanel::list() {
    recorder().list(maxRecordings, [this, listing = ++listing_](const SessionList &found) {
        if (listing != listing_)
            return; // asked for anew, maybe of another robot
        list_ = found;
        sessions_->tell(found);
        proposeName();
        showEnds();
        update();
    });
}

/// Unless somebody has typed one.
void RecordPanel::proposeName() {
    if (watch_.isRecording() && !name_->hasFocus())
        name_->setText(shortLine(watch_.name(), longestName));
    if (name_->isModified() || watch_.isRecording())
        return;
    const QString next = nextFreeName(name_->text().trimmed(), list_);
    if (next != name_->text())
        name_->setText(next);
}

void RecordPanel::play() {
    const RecordedSession *const session = sessions_->chosen();
    if (!session)
        return;
    if (watch_.isRecording())
        return message_->tell(tr("The robot is recording: nothing is replayed until that has ended."), true);
    QStringList lines = session->absent();
    lines.prepend(tr("Replaying %1.").arg(shortLine(session->name, longestName)));
    message_->tell(lines.join('\n'), lines.size() > 1);
    played_ = session->id;
    playedBy_ = fleet_.robot() ? fleet_.titleOf(*fleet_.robot()) : QString();
    bar_->begin(*session);
    player_.play(*session, {});
    listMarks(*session, watch_.members().timeout, this,
              [this, id = session->id](const std::vector<SessionMark> &marks, const QStringList &problems) {
                  if (id != played_)
                      return;
                  bar_->setMarks(marks);
                  if (!problems.isEmpty())
                      message_->tell(tr("Its marks cannot be shown: %1").arg(problems.join('\n')), true);
              });
    update();
}

void RecordPanel::setReplaying(bool isReplaying) {
    if (std::exchange(isReplaying_, isReplaying) != isReplaying)
        update();
}

void RecordPanel::update() {
    const bool isRecording = watch_.isRecording();
    if (std::exchange(wasRecording_, isRecording) != isRecording) {
        Q_EMIT recordingChanged(isRecording);
        if (!isRecording && message_->text() == begun_)
            message_->hide(); // whatever became of it
    }
    record_->setText(isRecording ? tr("S&top") : tr("Re&cord"));
    record_->setIcon(theme::icon(isRecording ? "stop" : "record"));
    record_->setEnabled(!watch_.members().all.empty() && (isRecording || !name_->text().trimmed().isEmpty()));
    name_->setEnabled(!isRecording);
    mark_->setVisible(watch_.marks());
    addMark_->setVisible(watch_.marks());
    showAmount();
    showLost();
    showStop();
    replay_->setEnabled(sessions_->chosen() && !isRecording);
    live_->setEnabled(player_.isPlaying() || isReplaying_);
}

void RecordPanel::showStop() {
    const RecordingStop *const stop = stops_.chosen();
    if (!stop || !stop->isUnderWay())
        return;
    const QStringList silent = stop->silent();
    message_->tell(silent.isEmpty()
                       ? tr("Stopping.")
                       : tr("%1 does not answer, and may go on recording. Stop is sent again until it "
                            "answers.")
                             .arg(silent.join(", ")),
                   !silent.isEmpty(), true);
}

void RecordPanel::showAmount() {
    const QStringList silent = watch_.silent();
    const QString amount = amountText(watch_, list_);
    amount_->setEnabled(silent.isEmpty()); // else it is old
    amount_->setText(
        silent.isEmpty() ? amount : tr("%1 does not answer; last known: %2").arg(silent.join(", "), amount));
}

void RecordPanel::showLost() {
    QStringList lines = stops_.silentElsewhere();
    if (!watch_.lost().empty())
        lines.append(lostText(watch_));
    lost_->setText(lines.join('\n'));
    lost_->setVisible(!lines.isEmpty());
}

} // namespace hermes::desktop
