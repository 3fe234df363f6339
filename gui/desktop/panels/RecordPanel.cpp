#include "gui/desktop/panels/RecordPanel.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/panels/ReplayBar.h"
#include "gui/desktop/panels/SessionTable.h"
#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/MessageLabel.h"
#include "gui/desktop/widgets/Quantities.h"
#include "protocol/wire/Fields.h"

#include <QAction>
#include <QFontDatabase>
#include <QLineEdit>
#include <QMessageBox>
#include <QPlainTextEdit>
#include <QPushButton>

#include <algorithm>

namespace hermes::desktop {
namespace {

constexpr int longestReport = 100000; // letters, of session.explain

/// What each daemon lost; one packet may count as several.
QString lossesText(const SessionState &now) {
    QString text;
    for (const SessionPart &part : now.parts) {
        QStringList losses;
        for (auto loss = part.losses.begin(); loss != part.losses.end(); ++loss)
            if (loss.value() > 0)
                losses.append(QString("%1 %2").arg(loss.key()).arg(loss.value(), 0, 'f', 0));
        if (!losses.isEmpty())
            text += RecordPanel::tr("; %1 lost: %2")
                        .arg(shortLine(part.daemon, longestName),
                             shortLine(losses.join(", ").replace('_', ' '), 100));
    }
    return text;
}

} // namespace

RecordPanel::RecordPanel(Fleet &fleet, Sessions &sessions, QWidget *parent)
    : QWidget(parent)
    , fleet_(fleet)
    , sessions_(sessions)
    , name_(named(new QLineEdit, "name", tr("Name of the session; without one it is date and time")))
    , mark_(named(new QLineEdit, "markText", tr("Without a text the mark gets a number")))
    , record_(named(new QPushButton, "record"))
    , addMark_(named(new QPushButton(tr("Mark")), "mark"))
    , replay_(named(new QPushButton(theme::icon("start"), tr("Repla&y")), "replay",
                    tr("Plays the chosen session through the same topics (double click)")))
    , live_(named(new QPushButton(tr("&Live")), "live", tr("Ends the replay")))
    , explain_(named(new QPushButton(tr("Explain")), "explain",
                     tr("Who drove in the chosen session, why it stopped, what was wrong")))
    , startRecorder_(named(new QPushButton(tr("Start the recorder")), "startRecorder"))
    , takeMark_(named(new QAction(tr("Mark this moment of the recording"), this), "takeMark"))
    , amount_(named(new PlainLabel, "amount"))
    , wrong_(named(new PlainLabel, "wrong"))
    , message_(new MessageLabel)
    , table_(new SessionTable) {
    addActions();
    layOut();
    connectAll();
    update();
}

void RecordPanel::addActions() {
    takeMark_->setShortcut(Qt::CTRL + Qt::Key_M);
    takeMark_->setShortcutContext(Qt::ApplicationShortcut); // floating panels, too
    addMark_->setToolTip(tr("Puts a mark into the recording (%1)").arg(takeMark_->shortcut().toString()));
    addAction(takeMark_);
    table_->setContextMenuPolicy(Qt::ActionsContextMenu);
    addHand(tr("Repla&y"), "replaySession", [this] { replay(); });
    addHand(tr("E&xplain"), "explainSession", [this] { explain(); });
    addHand(tr("Re&name"), "renameSession", [this] { table_->askForName(); });
    addHand(tr("&Remove..."), "removeSession", [this] { remove(); });
}

void RecordPanel::addHand(const QString &text, const char *name, const std::function<void()> &work) {
    auto *const action = named(new QAction(text, table_), name);
    connect(action, &QAction::triggered, this, work);
    table_->addAction(action);
}

void RecordPanel::layOut() {
    name_->setPlaceholderText(tr("Date and time"));
    amount_->setWordWrap(true);
    amount_->setMinimumSize(1, 2 * fontMetrics().lineSpacing()); // else the list moves under the mouse
    amount_->setAlignment(Qt::AlignTop);
    wrong_->letWrap();
    theme::tint(*wrong_, QPalette::WindowText, Condition::Fault);
    mark_->setPlaceholderText(tr("What to remember of this moment"));
    mark_->setMaxLength(1000);
    // The table gives its room to what is told below it: no button moves.
    setLayout(inColumn({inRow({{name_, 1}, record_}),
                        inRow({{mark_, 1}, addMark_}),
                        amount_,
                        startRecorder_,
                        {table_, 1},
                        wrong_,
                        message_,
                        new ReplayBar(sessions_),
                        inRow({replay_, live_, explain_})}));
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
    connect(record_, &QPushButton::clicked, this, &RecordPanel::record);
    connect(name_, &QLineEdit::returnPressed, record_, &QPushButton::click);
    connect(addMark_, &QPushButton::clicked, this, &RecordPanel::mark);
    connect(mark_, &QLineEdit::returnPressed, addMark_, &QPushButton::click);
    connect(takeMark_, &QAction::triggered, this, &RecordPanel::mark);
    connect(replay_, &QPushButton::clicked, this, &RecordPanel::replay);
    connect(live_, &QPushButton::clicked, this, [this] { ask("session.live", {}); });
    connect(explain_, &QPushButton::clicked, this, &RecordPanel::explain);
    connect(startRecorder_, &QPushButton::clicked, this, &RecordPanel::startRecorder);
    connect(table_, &SessionTable::currentItemChanged, this, &RecordPanel::update);
    connect(table_, &SessionTable::itemActivated, this, &RecordPanel::replay);
    connect(table_, &SessionTable::renameWanted, this, [this](const QString &name, const QString &to) {
        ask("session.rename", {{"name", name}, {"to", to}}, [this](const auto &) { list(); });
    });
    connect(&sessions_, &Sessions::changed, this, &RecordPanel::update);
    connect(&sessions_, &Sessions::refused, this, [this](const QString &why) { message_->tell(why, true); });
    connect(&fleet_, &Fleet::robotChosen, this, [this] {
        table_->tell({}); // what was told of another robot is not of this one
        message_->hide();
        dialog_.close();
    });
}

void RecordPanel::ask(const QString &method, const QJsonObject &params, const Taken &taken) {
    sessions_.call(method, params, this, [this, taken](const Result<QJsonValue> &answer) {
        if (!answer) {
            message_->tell(answer.error().message, true);
            list(); // as it is, not as somebody wanted it
        } else if (taken) {
            taken(*answer);
        }
    });
}

void RecordPanel::askOfChosen(const QString &method, QJsonObject params, const Taken &taken) {
    if (!table_->chosen())
        return;
    params["name"] = table_->chosen()->name;
    ask(method, params, taken);
}

void RecordPanel::startRecorder() {
    DaemonLink *const supervisor = fleet_.robot() ? fleet_.robot()->withMethod("process.start") : nullptr;
    if (supervisor)
        supervisor->call(
            "process.start", {{"name", "recorder"}}, this, [this](const Result<QJsonValue> &answer) {
                message_->tell(answer ? tr("The recorder starts.") : answer.error().message, !answer);
            });
}

void RecordPanel::record() {
    if (sessions_.isRecording())
        return ask("session.stop", {});
    const QString name = name_->text().trimmed();
    ask("session.start", name.isEmpty() ? QJsonObject() : QJsonObject{{"name", name}},
        [this](const QJsonValue &state) {
            message_->tell(tr("Recording %1.").arg(shortLine(state["name"].toString(), longestName)));
            name_->clear();
        });
}

void RecordPanel::mark() {
    const QString typed = mark_->text();
    marks_ = std::max(marks_, int(sessions_.state().marks.size()));
    const QString text = typed.trimmed().isEmpty() ? tr("mark %1").arg(marks_ + 1) : typed.trimmed();
    marks_ += sessions_.isRecording();
    ask("session.mark", {{"text", text}}, [this, typed, text](const QJsonValue &) {
        message_->tell(tr("Marked: %1").arg(text));
        if (mark_->text() == typed)
            mark_->clear();
    });
}

void RecordPanel::list() {
    ++listing_;
    if (!sessions_.isThere())
        return table_->tell({});
    sessions_.call("session.list", {{"max", maxSessions}}, this,
                   [this, listing = listing_](const Result<QJsonValue> &answer) {
                       if (listing != listing_)
                           return; // asked for anew, maybe of another robot
                       ReadReport report;
                       std::vector<SessionSummary> found;
                       if (answer)
                           for (const QJsonValue &told : answer->toArray())
                               if (auto one = readMessage<SessionSummary>(WireValue(told), report);
                                   one && found.size() < maxSessions)
                                   found.push_back(std::move(*one));
                       if (!answer || report.hasFailed())
                           message_->tell(
                               tr("The list of sessions: %1")
                                   .arg(answer ? shortLine(report.text()) : answer.error().message),
                               true);
                       table_->tell(found);
                       update();
                   });
}

void RecordPanel::remove() {
    const SessionSummary *const session = table_->chosen();
    if (!session)
        return;
    const QString name = session->name;
    auto *const box = new QMessageBox(QMessageBox::Question, tr("Recordings"),
                                      tr("Remove %1, %2 of %3? Nothing brings it back.")
                                          .arg(shortLine(name, longestName), sizeText(session->bytes),
                                               shortLine(session->daemons.join(", "))),
                                      QMessageBox::Cancel, this);
    box->setObjectName("removal");
    box->setTextFormat(Qt::PlainText);
    QPushButton *const accept = box->addButton(tr("&Remove"), QMessageBox::AcceptRole);
    box->setDefaultButton(QMessageBox::Cancel);
    connect(accept, &QPushButton::clicked, this, [this, name] {
        ask("session.remove", {{"name", name}, {"confirm", true}}, [this, name](const QJsonValue &) {
            message_->tell(tr("Removed: %1").arg(shortLine(name, longestName)));
            list();
        });
    });
    dialog_.show(box);
}

void RecordPanel::replay() {
    askOfChosen("session.replay", {}, [this](const QJsonValue &) { message_->hide(); });
}

void RecordPanel::explain() {
    askOfChosen("session.explain", {}, [this](const QJsonValue &answer) {
        auto *const dialog = named(new QDialog(this), "explanation");
        dialog->setWindowTitle(tr("What happened"));
        auto *const text = new QPlainTextEdit(shortText(answer["text"].toString(), longestReport));
        text->setReadOnly(true);
        text->setFont(QFontDatabase::systemFont(QFontDatabase::FixedFont));
        dialog->setLayout(inColumn({text}));
        dialog->resize(80 * text->fontMetrics().averageCharWidth(), 30 * text->fontMetrics().lineSpacing());
        dialog_.show(dialog);
    });
}

void RecordPanel::update() {
    const SessionState &now = sessions_.state();
    const bool isThere = sessions_.isThere(), isRecording = sessions_.isRecording();
    const QString listFor =
        isThere ? sessions_.recorder()->address() + ' ' + now.session + ' ' + now.state : QString();
    if (std::exchange(listedFor_, listFor) != listFor) // whoever began or ended one
        list();
    const QString before = std::exchange(recorded_, isRecording ? now.session : QString());
    if (before != recorded_)
        marks_ = 0;
    if (!isRecording && !before.isEmpty() && before == now.session) {
        table_->setCurrentItem(nullptr); // the latest is chosen
        message_->tell(now.problems.isEmpty()
                           ? tr("%1 has ended, nothing missing.").arg(shortLine(now.name, longestName))
                           : tr("%1 has ended.").arg(shortLine(now.name, longestName)),
                       !now.problems.isEmpty());
    }
    record_->setText(isRecording ? tr("S&top") : tr("Re&cord"));
    record_->setIcon(theme::icon(isRecording ? "stop" : "record"));
    record_->setEnabled(isThere);
    mark_->setVisible(isRecording);
    addMark_->setVisible(isRecording);
    const DaemonLink *const supervisor =
        fleet_.robot() ? fleet_.robot()->withMethod("process.start") : nullptr;
    startRecorder_->setVisible(!isThere && supervisor && supervisor->may("process.start"));
    const bool isChosen = isThere && table_->chosen();
    for (QAction *const action : table_->actions())
        action->setEnabled(isChosen);
    explain_->setEnabled(isChosen);
    replay_->setEnabled(isChosen && !isRecording);
    live_->setEnabled(isThere && now.state == "replaying");
    amount_->setEnabled(isThere && !sessions_.recorder()->isSilent()); // else it is old
    amount_->setText(amount());
    wrong_->setText(wrong());
    wrong_->setVisible(!wrong_->text().isEmpty());
}

QString RecordPanel::amount() const {
    const SessionState &now = sessions_.state();
    if (!sessions_.recorder())
        return fleet_.robot() ? tr("The robot has no recorder: nothing is recorded.") : QString();
    const QString name = shortLine(now.name, longestName);
    QString text = tr("Records all that the daemons of the robot tell.");
    if (sessions_.isRecording()) {
        text = tr("%1: %2, %3").arg(name, durationText(now.duration_s), sizeText(now.bytes));
        if (now.left_s)
            text += tr(", the disk will do for %1").arg(durationText(*now.left_s));
        text += lossesText(now);
    } else if (now.state == "starting") {
        text = tr("%1 begins.").arg(name);
    } else if (now.state == "replaying") {
        text = tr("%1 is replayed.").arg(name);
    }
    return sessions_.isThere() && !sessions_.recorder()->isSilent()
               ? text
               : tr("The recorder does not answer, and goes on by itself; last known: %1").arg(text);
}

/// What is wrong with what is recorded, or was last.
QString RecordPanel::wrong() const {
    QStringList lines = sessions_.state().problems;
    if (!sessions_.problem().isEmpty())
        lines.prepend(sessions_.problem());
    if (sessions_.isRecording())
        for (const QString &daemon : sessions_.state().silent)
            lines.append(tr("%1 does not answer.").arg(daemon));
    return shortText(lines.join('\n'));
}

} // namespace hermes::desktop
