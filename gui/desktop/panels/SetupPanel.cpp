#include "gui/desktop/panels/SetupPanel.h"

#include "common/settings/DottedPath.h"
#include "gui/desktop/Theme.h"
#include "gui/desktop/panels/WheelsTest.h"
#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/MessageLabel.h"
#include "gui/setup/SetupText.h"
#include "protocol/wire/Fields.h"
#include "protocol/wire/JsonText.h"

#include <QCheckBox>
#include <QComboBox>
#include <QHeaderView>
#include <QProgressBar>
#include <QPushButton>
#include <QSplitter>
#include <QTreeWidget>

namespace hermes::desktop {
namespace {

enum ChangeColumn { SettingColumn, NowColumn, NewColumn };
constexpr int maxFindings = 500;

QTreeWidget *makeTable(const QString &name, const QStringList &header) {
    auto *const table = named(new QTreeWidget, name);
    table->setAccessibleName(header.front());
    table->setHeaderLabels(header);
    table->setUniformRowHeights(true);
    table->setRootIsDecorated(false);
    table->header()->setSectionResizeMode(0, QHeaderView::ResizeToContents);
    return table;
}

QTreeWidgetItem *rowOf(const QStringList &texts) {
    auto *const row = new QTreeWidgetItem;
    for (int i = 0; i < texts.size(); ++i) {
        row->setText(i, shortLine(texts[i]));
        row->setToolTip(i, toolTipOf(shortText(texts[i])));
    }
    return row;
}

/// What a search has found, in words.
QString spokenKind(const QString &kind) {
    static const QHash<QString, QString> words{
        {"nmea", SetupPanel::tr("GPS receiver")},      {"scanner", SetupPanel::tr("scanner")},
        {"talker", SetupPanel::tr("unknown, talks")},  {"other", SetupPanel::tr("unknown, answers")},
        {"not_asked", SetupPanel::tr("not asked")},    {"in_use", SetupPanel::tr("in use")},
        {"failed", SetupPanel::tr("cannot be opened")}};
    if (FoundSerial::controllerKinds().contains(kind))
        return SetupPanel::tr("motors");
    return words.value(kind, kind);
}

} // namespace

SetupPanel::SetupPanel(Fleet &fleet, QWidget *parent)
    : QWidget(parent)
    , fleet_(fleet)
    , samples_(
          named(new QComboBox, "samples", tr("Settings of a whole robot to begin with, or those of now")))
    , ask_(named(new QCheckBox(tr("Ask silent lines: wheels lifted,\nor motors without power")), "ask",
                 tr("Silent lines are asked whether they lead to a RoboClaw; another motor controller may "
                    "take that for a speed")))
    , release_(named(new QCheckBox(tr("End daemons for the search:\nthe robot stands")), "release",
                     tr("Daemons that use serial lines or hear lidars are ended and started again; what they "
                        "record ends. Otherwise their devices are left alone")))
    , find_(named(new QPushButton(tr("Searc&h")), "findDevices"))
    , apply_(named(new QPushButton(theme::icon("apply"), tr("Apply")), "applySetup"))
    , undo_(named(new QPushButton(theme::icon("revert"), tr("Undo")), "undoSetup"))
    , progress_(named(new QProgressBar, "setupProgress"))
    , found_(makeTable("found", {tr("Found"), tr("Where"), tr("Details")}))
    , changes_(makeTable("changes", {tr("To be written"), tr("Now"), tr("New")}))
    , message_(new MessageLabel) {
    auto *const wheels = new WheelsTest(fleet);
    auto *const tables = new QSplitter;
    tables->addWidget(found_);
    tables->addWidget(changes_);
    setLayout(inColumn({{inRow({makeSteps(), {tables, 1}, wheels}), 1}, message_}));
    layout()->setContentsMargins(9, 2, 9, 2);

    connect(find_, &QPushButton::clicked, this, &SetupPanel::find);
    connect(apply_, &QPushButton::clicked, this, &SetupPanel::apply);
    connect(undo_, &QPushButton::clicked, this, &SetupPanel::undo);
    connect(samples_, QOverload<int>::of(&QComboBox::activated), this, &SetupPanel::propose);
    connect(wheels, &WheelsTest::ended, this, [this](const QJsonObject &changed) {
        const QJsonObject settings = changed.isEmpty()
                                         ? QJsonObject()
                                         : QJsonObject{{"motorcontrol", QJsonObject{{"wheels", changed}}}};
        showChanges({}, settings, changesOf(settings));
    });
    connect(&fleet, &Fleet::changed, this, &SetupPanel::follow);
    connect(&fleet, &Fleet::robotChosen, this, &SetupPanel::follow);
    follow();
}

QWidget *SetupPanel::makeSteps() {
    progress_->setRange(0, 0);
    progress_->setTextVisible(false);
    progress_->hide();
    QLayout *const writing = inRow({find_, apply_, undo_});
    return filled(new QWidget, inColumn({samples_, release_, ask_, writing, progress_, Part::room()}),
                  4); // all of it without scrolling
}

QString SetupPanel::sample() const {
    return samples_->currentData().toString();
}

void SetupPanel::follow() {
    DaemonLink *const supervisor = fleet_.robot() ? fleet_.robot()->withMethod("setup.find") : nullptr;
    if (supervisor == supervisor_)
        return updateButtons();
    supervisor_ = supervisor;
    isBusy_ = hasSearched_ = false;
    ask_->setChecked(false);
    release_->setChecked(false);
    folder_.clear();
    found_->clear();
    samples_->clear();
    samples_->addItem(tr("Change the settings of now"), QString());
    message_->hide();
    showChanges({}, {}, {});
    if (!supervisor)
        return;
    supervisor->call(
        "settings.get", {{"path", "setup.folder"}}, this,
        [this](const Result<QJsonValue> &folder) { folder_ = folder ? folder->toString() : QString(); });
    call<QStringList>("setup.samples", {}, [this](const QStringList &names) {
        for (const QString &name : names.mid(0, maxFindings))
            samples_->addItem(tr("Begin with the sample %1").arg(shortLine(name, 40)), name);
    });
}

void SetupPanel::updateButtons() {
    const QString why = supervisor_ ? supervisor_->refusal("setup.find")
                                    : tr("Only with the supervisor of the robot, which is not connected");
    const bool isFree = why.isEmpty() && !isBusy_;
    find_->setEnabled(isFree);
    find_->setToolTip(why.isEmpty() ? tr("Looks for some seconds what is plugged in") : why);
    apply_->setEnabled(isFree && changes_->topLevelItemCount() > 0);
    apply_->setToolTip(why.isEmpty() ? tr("Writes it, if all daemons would take theirs") : why);
    undo_->setEnabled(isFree);
    undo_->setToolTip(why.isEmpty() ? tr("Puts back what the last Apply has replaced, whatever was changed "
                                         "since; that stays beside, as NAME.json.undone")
                                    : why);
    samples_->setEnabled(isFree);
    ask_->setEnabled(isFree);
    release_->setEnabled(isFree);
    progress_->setVisible(isBusy_);
}

template <typename T>
void SetupPanel::call(const QString &method, const QJsonObject &params, const Then<T> &then) {
    if (!supervisor_ || isBusy_)
        return;
    isBusy_ = true;
    updateButtons();
    const auto answered = [this, method, then, guard = QPointer<SetupPanel>(this),
                           asked = supervisor_](const Result<QJsonValue> &answer) {
        if (!guard || asked != supervisor_)
            return; // another robot was chosen
        isBusy_ = false;
        updateButtons();
        if (!answer)
            return message_->tell(answer.error().message, true);
        ReadReport report;
        const auto message = readMessage<T>(WireValue(*answer), report);
        message ? then(*message) : message_->tell(method + ": " + report.text(), true);
    };
    supervisor_->client().call(method, params, answered, setupTimeout);
}

void SetupPanel::find() {
    message_->tell(tr("Listening and asking; this takes some seconds."));
    call<Findings>("setup.find", {{"ask", ask_->isChecked()}, {"release", release_->isChecked()}},
                   [this](const Findings &found) {
                       hasSearched_ = true;
                       ask_->setChecked(false);
                       release_->setChecked(false);
                       showFound(found);
                       propose();
                   });
}

void SetupPanel::showFound(const Findings &found) {
    found_->clear();
    for (QStringList &row : rowsOf(found, tr("the tick \"Ask silent lines\"")))
        if (found_->topLevelItemCount() < maxFindings) {
            row.front() = spokenKind(row.front());
            found_->addTopLevelItem(rowOf(row));
        }
    found_->resizeColumnToContents(1);
    if (found_->topLevelItemCount() == 0)
        found_->addTopLevelItem(rowOf({tr("nothing")}));
}

void SetupPanel::propose() {
    showChanges({}, {}, {});
    if (!supervisor_ || (sample().isEmpty() && !hasSearched_))
        return;
    const auto proposed = [this, asked = sample()](const Result<QJsonValue> &answer) {
        if (asked != sample())
            return; // another one was chosen
        ReadReport report;
        const auto proposal = answer ? readMessage<Proposal>(WireValue(*answer), report) : std::nullopt;
        if (!proposal)
            return message_->tell("setup.propose: " + (answer ? report.text() : answer.error().message),
                                  true);
        showChanges(asked, proposal->settings, proposal->changes);
        QStringList notes = proposal->notes;
        if (notes.isEmpty() && proposal->changes.empty())
            notes.append(tr("Nothing is to be changed."));
        message_->setVisible(!notes.isEmpty());
        if (!notes.isEmpty())
            message_->tell(notes.join('\n'));
    };
    supervisor_->call("setup.propose", {{"sample", sample()}}, this, proposed);
}

void SetupPanel::showChanges(const QString &sample, const QJsonObject &settings,
                             const std::vector<SettingChange> &changes) {
    changedSample_ = sample;
    changedSettings_ = settings;
    changes_->clear();
    QTreeWidgetItem *file = nullptr;
    QString last;
    int rows = 0;
    for (const SettingChange &change : changes) {
        if (++rows > maxFindings)
            break;
        if (change.daemon != last) {
            if (file)
                showNow(last, *file);
            file = rowOf({tr("%1/%2.json").arg(folder_, last = change.daemon)});
            changes_->addTopLevelItem(file);
            file->setFirstColumnSpanned(true);
            file->setExpanded(true);
        }
        file->addChild(
            rowOf({change.path, change.now, change.value.isEmpty() ? tr("(default)") : change.value}));
    }
    if (file)
        showNow(last, *file);
    changes_->resizeColumnToContents(NowColumn);
    changes_->setColumnWidth(NowColumn, qMin(changes_->columnWidth(NowColumn), 160));
    updateButtons();
}

/// Where the file says nothing, what a daemon that runs has there.
void SetupPanel::showNow(const QString &daemon, QTreeWidgetItem &item) {
    DaemonLink *const link = fleet_.robot() ? fleet_.robot()->withName(daemon) : nullptr;
    if (!link || !link->isConnected())
        return;
    const auto show = [this, index = changes_->indexOfTopLevelItem(&item), sample = changedSample_,
                       settings = changedSettings_](const Result<QJsonValue> &now) {
        QTreeWidgetItem *const file = changes_->topLevelItem(index);
        if (!now || !file || sample != changedSample_ || settings != changedSettings_)
            return;
        for (int i = 0; i < file->childCount(); ++i) {
            QTreeWidgetItem &row = *file->child(i);
            const QJsonValue value = valueAt(now->toObject(), row.text(SettingColumn));
            if (!row.text(NowColumn).isEmpty() || value.isUndefined())
                continue;
            const QString text = QString::fromUtf8(compactJson(value));
            row.setText(NowColumn, shortLine(text));
            row.setToolTip(NowColumn, toolTipOf(shortText(text)));
        }
    };
    link->call("settings.get", {}, this, show);
}

void SetupPanel::apply() {
    message_->tell(tr("The daemons check the settings."));
    call<Applied>("setup.apply", {{"sample", changedSample_}, {"settings", changedSettings_}},
                  [this](const Applied &applied) {
                      showChanges({}, {}, {});
                      samples_->setCurrentIndex(0);
                      tellApplied(applied);
                  });
}

void SetupPanel::undo() {
    call<Applied>("setup.undo", {}, [this](const Applied &applied) {
        showChanges({}, {}, {});
        tellApplied(applied);
    });
}

void SetupPanel::tellApplied(const Applied &applied) {
    QString text = tr("Written: %1").arg(applied.files.join(", "));
    if (!applied.restarted.isEmpty())
        text += tr(". Started: %1").arg(applied.restarted.join(", "));
    message_->tell(QStringList(QStringList(text) + applied.notes).join('\n'));
}

} // namespace hermes::desktop
