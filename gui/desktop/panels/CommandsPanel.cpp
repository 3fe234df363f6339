#include "gui/desktop/panels/CommandsPanel.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/model/MethodSchema.h"
#include "gui/desktop/panels/ButtonsEditor.h"
#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/PlainLabel.h"
#include "gui/desktop/widgets/SchemaForm.h"
#include "protocol/wire/JsonText.h"

#include <QElapsedTimer>
#include <QJsonArray>
#include <QLineEdit>
#include <QListWidget>
#include <QMenu>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QScrollArea>
#include <QSplitter>
#include <QStackedWidget>

namespace hermes::desktop {
namespace {

constexpr int longestMethod = 80, longestLine = 500, longestAnswer = 100000, maxMethods = 1000;

QString text(const QJsonValue &value) {
    if (value.isObject() || value.isArray())
        return indentedJson(value);
    return value.isString() ? value.toString() : value.isNull() ? "null" : value.toVariant().toString();
}

/// A line without end would be laid out for seconds.
QString folded(const QString &text) {
    QStringList lines;
    for (const QString &line : text.split('\n'))
        for (int i = 0; i == 0 || i < line.size(); i += longestLine)
            lines.append(line.mid(i, longestLine));
    return lines.join('\n');
}

QString readable(const QJsonValue &value) {
    const QString all = text(value);
    const QString shown = folded(all.left(longestAnswer));
    return all.size() <= longestAnswer
               ? shown
               : shown + CommandsPanel::tr("\n... and %1 more characters").arg(all.size() - longestAnswer);
}

} // namespace

CommandsPanel::CommandsPanel(Fleet &fleet, Buttons &buttons, QWidget *parent)
    : QWidget(parent)
    , fleet_(fleet)
    , buttons_(buttons)
    , pages_(new QStackedWidget)
    , editor_(new ButtonsEditor(fleet, buttons)) {
    answer_ = named(new QPlainTextEdit, "answer");
    answer_->setReadOnly(true);
    answer_->setFont(theme::fixedFont());
    answer_->setPlaceholderText(tr("The answer appears here."));
    auto *const splitter = new QSplitter;
    for (QWidget *const column : {makeMethods(), makeCall(), static_cast<QWidget *>(answer_)})
        splitter->addWidget(column);
    splitter->setStretchFactor(1, 2);
    splitter->setStretchFactor(2, 2);
    splitter->setSizes({220, 560, 460});
    setLayout(inColumn({pages_}));
    pages_->addWidget(splitter);
    pages_->addWidget(editor_);
    connect(editor_, &ButtonsEditor::closed, this, [this] { pages_->setCurrentIndex(0); });
    connect(&buttons, &Buttons::changed, this, &CommandsPanel::offerSteps);
    offerSteps();

    connect(&fleet, &Fleet::daemonChosen, this, &CommandsPanel::follow);
    connect(&fleet, &Fleet::changed, this, &CommandsPanel::update);
    follow(fleet.daemon());
}

QWidget *CommandsPanel::makeMethods() {
    title_ = named(new PlainLabel, "title");
    title_->setWordWrap(true);
    filter_ = named(new QLineEdit, "filter");
    filter_->setPlaceholderText(tr("Find a command"));
    filter_->setClearButtonEnabled(true);
    methods_ = named(new QListWidget, "methods");
    methods_->setAccessibleName(tr("The commands of the daemon"));
    connect(filter_, &QLineEdit::textChanged, this, &CommandsPanel::listMethods);
    connect(methods_, &QListWidget::currentItemChanged, this, [this](const QListWidgetItem *item) {
        showMethod(item ? item->data(Qt::UserRole).toString() : QString());
    });
    return filled(new QWidget, inColumn({title_, filter_, {methods_, 1}}));
}

QWidget *CommandsPanel::makeCall() {
    summary_ = named(new PlainLabel, "summary");
    summary_->letWrap();
    form_ = new SchemaForm;
    QScrollArea *const method = scrolled(filled(new QWidget, inColumn({summary_, {form_, 1}})));
    QLayout *const actions = makeActions();
    connect(form_, &SchemaForm::edited, this, &CommandsPanel::update);
    connect(&second_, &SecondPress::changed, this, &CommandsPanel::update);
    return filled(new QWidget, inColumn({{method, 1}, actions}));
}

QLayout *CommandsPanel::makeActions() {
    call_ = named(new QPushButton(theme::icon("call"), tr("Ru&n")), "call");
    call_->setMinimumWidth(1); // what is replaced may be long
    addButton_ = named(new QPushButton(theme::icon("add"), tr("Add as a button")), "addButton",
                       tr("A button of your own that runs this command with these parameters"));
    addStep_ = named(new QPushButton(tr("as a step")), "addStep",
                     tr("Adds this command to one of your buttons, after what that one does already"));
    addStep_->setAccessibleName(tr("Add as a step of a button"));
    addStep_->setMenu(new QMenu(this));
    connect(call_, &QPushButton::clicked, this, &CommandsPanel::call);
    connect(addButton_, &QPushButton::clicked, this, &CommandsPanel::addButton);
    connect(addStep_->menu(), &QMenu::triggered, this,
            [this](const QAction *chosen) { addStep(chosen->data().toInt()); });
    return inRow({{call_, 1}, addButton_, addStep_});
}

/// As it is typed; nothing, and it says so: it cannot be kept.
std::optional<MacroStep> CommandsPanel::typedStep() {
    const MacroStep step = MacroStep::of(fleet_, *daemon_, method_, form_->values());
    const QString problem = step.problem();
    if (problem.isEmpty())
        return step;
    answer_->setPlainText(tr("Not added. %1").arg(problem));
    return std::nullopt;
}

void CommandsPanel::addButton() {
    if (!daemon_ || method_.isEmpty())
        return; // it went meanwhile
    const auto step = typedStep();
    if (!step)
        return;
    buttons_.add({shortLine(method_, Macro::longestName - 3), {*step}});
    editButtons();
    editor_->choose(int(buttons_.all().size()) - 1);
    editor_->nameIt();
}

void CommandsPanel::addStep(int place) {
    if (!daemon_ || method_.isEmpty() || place >= int(buttons_.all().size()))
        return; // a menu may be open for long
    const auto step = typedStep();
    if (!step)
        return;
    Macro macro = buttons_.all().at(std::size_t(place));
    macro.steps.push_back(*step);
    buttons_.set(place, macro);
    answer_->setPlainText(tr("Added to %1 as step %2: %3")
                              .arg(macro.name)
                              .arg(macro.steps.size())
                              .arg(shortLine(step->title())));
}

void CommandsPanel::editButtons() {
    pages_->setCurrentWidget(editor_);
}

void CommandsPanel::offerSteps() {
    QMenu *const menu = addStep_->menu();
    menu->clear();
    for (int i = 0; i < int(buttons_.all().size()); ++i) {
        const Macro &macro = buttons_.all()[std::size_t(i)];
        QAction *const action = menu->addAction(labelText(macro.name));
        action->setData(i);
        action->setEnabled(int(macro.steps.size()) < Macro::maxSteps);
    }
    update();
}

void CommandsPanel::follow(DaemonLink *daemon) {
    if (daemon_)
        daemon_->disconnect(this);
    daemon_ = daemon;
    if (daemon) {
        connect(daemon, &DaemonLink::described, this, [this] {
            listMethods();
            showMethod(method_);
        });
        connect(daemon, &DaemonLink::changed, this, &CommandsPanel::update);
    }
    answer_->clear();
    showMethod({});
    listMethods();
}

void CommandsPanel::listMethods() {
    const QSignalBlocker silence(methods_);
    methods_->clear();
    int unlisted = 0;
    if (daemon_)
        for (const QJsonValue &method : daemon_->description()["methods"].toArray()) {
            const QString name = method["name"].toString();
            if (!(name + method["summary"].toString()).contains(filter_->text(), Qt::CaseInsensitive))
                continue;
            if (methods_->count() >= maxMethods) {
                ++unlisted;
                continue;
            }
            auto *const item = new QListWidgetItem(shortLine(name, longestMethod), methods_);
            item->setData(Qt::UserRole, name);
            item->setToolTip(toolTipOf(method["summary"].toString()));
            if (name == method_)
                methods_->setCurrentItem(item);
        }
    filter_->setPlaceholderText(unlisted == 0 ? tr("Find a command")
                                              : tr("Find one of %1 more").arg(unlisted));
    if (!methods_->currentItem())
        showMethod({}); // nobody has chosen one: a press of Run is to run nothing
    update();
}

void CommandsPanel::showMethod(const QString &name) {
    method_ = name;
    second_.forget();
    const QJsonObject method = daemon_ ? daemon_->method(name) : QJsonObject();
    QString summary = method["summary"].toString();
    if (method["x-needs-lease"].toBool())
        summary += tr(" (needs the control)");
    if (const QString lost = method["x-destructive"].toString(); !lost.isEmpty())
        summary += tr(" (replaces or forgets %1)").arg(lost);
    summary_->setText(summary);
    form_->setSchema(parametersOf(method), {});
    update();
}

void CommandsPanel::call() {
    const QString method = method_;
    if (!daemon_->method(method)["x-destructive"].toString().isEmpty() && !second_.press())
        return;
    QElapsedTimer time;
    time.start();
    answer_->setPlainText(tr("%1 ...").arg(shortLine(method)));
    daemon_->callForMuch(method, form_->values(), this, [=, asked = daemon_](const auto &result) {
        if (asked != daemon_)
            return; // another's answers are shown now
        const QString took =
            tr("%1: %2 ms").arg(shortLine(method)).arg(double(time.nsecsElapsed()) * 1e-6, 0, 'f', 1);
        if (result)
            return answer_->setPlainText(took + "\n" + (result->isNull() ? tr("done") : readable(*result)));
        const Error &error = result.error();
        answer_->setPlainText(
            tr("%1\nError %2: %3\n%4")
                .arg(took)
                .arg(error.code)
                .arg(shortText(error.message), error.data.isUndefined() ? QString() : readable(error.data)));
        if (method == method_)
            form_->showErrors(error.data.toObject()["errors"].toArray());
    });
}

void CommandsPanel::update() {
    title_->setBold(daemon_);
    title_->setText(daemon_ ? fleet_.titleOf(*daemon_) : tr("Choose a daemon to see its commands."));
    const QString why = daemon_ ? daemon_->refusal(method_) : QString();
    const QString lost = daemon_ ? daemon_->method(method_)["x-destructive"].toString() : QString();
    call_->setText(second_.isAwaited()
                       ? tr("Ru&n %1 now: replaces or forgets %2").arg(method_, shortLine(lost))
                       : tr("Ru&n"));
    call_->setToolTip(why);
    const bool isWhole = daemon_ && !method_.isEmpty() && form_->isValid();
    call_->setEnabled(isWhole && daemon_->isConnected() && why.isEmpty());
    addButton_->setEnabled(isWhole && !buttons_.isFull());
    addStep_->setEnabled(isWhole && !buttons_.all().empty());
}

} // namespace hermes::desktop
