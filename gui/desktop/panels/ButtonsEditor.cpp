#include "gui/desktop/panels/ButtonsEditor.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/model/MethodSchema.h"
#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/FieldText.h"
#include "gui/desktop/widgets/MessageLabel.h"
#include "gui/desktop/widgets/SchemaForm.h"

#include <QLineEdit>
#include <QListWidget>
#include <QPushButton>
#include <QScrollArea>
#include <QToolButton>

namespace hermes::desktop {
namespace {

void fill(QListWidget &list, const QStringList &texts, int current) {
    const QSignalBlocker silence(list);
    list.clear();
    list.addItems(texts);
    list.setCurrentRow(std::min(current, list.count() - 1));
}

} // namespace

ButtonsEditor::ButtonsEditor(const Fleet &fleet, Buttons &buttons, QWidget *parent)
    : QWidget(parent)
    , fleet_(fleet)
    , buttons_(buttons) {
    filled(this, inRow({{makeList(), 2}, {makeSteps(), 3}, {makeStep(), 4}}));
    connect(&buttons, &Buttons::changed, this, [this] {
        if (!isChanging_)
            showAll();
    });
    showAll();
}

/// Up, down, and remove.
std::array<QToolButton *, 3> ButtonsEditor::makeTools(const QString &name, const QString &up,
                                                      const QString &down, const QString &remove) {
    const std::array<QToolButton *, 3> tools{named(new QToolButton, name + "Up", up),
                                             named(new QToolButton, name + "Down", down),
                                             named(new QToolButton, name + "Remove", remove)};
    for (QToolButton *const tool : tools)
        tool->setAccessibleName(tool->toolTip());
    tools[0]->setArrowType(Qt::UpArrow);
    tools[1]->setArrowType(Qt::DownArrow);
    tools[2]->setIcon(theme::icon("remove"));
    return tools;
}

QWidget *ButtonsEditor::makeList() {
    auto *const back =
        named(new QPushButton(tr("Back to the commands")), "closeButtons", tr("Commands are added there"));
    list_ = named(new QListWidget, "buttonList");
    list_->setAccessibleName(tr("Buttons"));
    listTools_ = makeTools("button", tr("Moves the button to the left"), tr("Moves the button to the right"),
                           tr("Removes the button"));
    const auto [up, down, remove] = listTools_;
    connect(back, &QPushButton::clicked, this, &ButtonsEditor::closed);
    connect(list_, &QListWidget::currentRowChanged, this, &ButtonsEditor::showSteps);
    const auto move = [this](int by) {
        const int place = button();
        buttons_.move(place, by);
        choose(place + by);
    };
    connect(up, &QToolButton::clicked, this, [move] { move(-1); });
    connect(down, &QToolButton::clicked, this, [move] { move(1); });
    connect(remove, &QToolButton::clicked, this, [this] { buttons_.remove(button()); });
    return filled(new QWidget, inColumn({back, {list_, 1}, inRow({up, down, remove, Part::room()})}));
}

QWidget *ButtonsEditor::makeSteps() {
    name_ = named(new QLineEdit, "buttonName");
    name_->setMaxLength(Macro::longestName);
    name_->setPlaceholderText(tr("Name of the button"));
    name_->setAccessibleName(tr("Name of the button"));
    steps_ = named(new QListWidget, "buttonSteps");
    steps_->setAccessibleName(tr("Its commands, in their order"));
    stepTools_ = makeTools("step", tr("Runs the command earlier"), tr("Runs the command later"),
                           tr("Removes the command"));
    const auto [up, down, remove] = stepTools_;
    pause_ = named(new QLineEdit, "stepPause",
                   tr("Seconds between the answer to this command and the next one, at most 3600"));
    pause_->setFixedWidth(fontMetrics().horizontalAdvance("3600.00") + 16);
    pause_->setAccessibleName(tr("Pause after the command in seconds"));
    connect(name_, &QLineEdit::textEdited, this, [this](const QString &name) {
        if (name.trimmed().isEmpty() || button() < 0)
            return;
        changeMacro([&](Macro &macro) { macro.name = name.trimmed(); });
        list_->currentItem()->setText(shortLine(name));
    });
    connect(name_, &QLineEdit::editingFinished, this, &ButtonsEditor::showTexts);
    connect(steps_, &QListWidget::currentRowChanged, this, &ButtonsEditor::showStep);
    connect(pause_, &QLineEdit::textEdited, this, [this](QString text) {
        const double pause_s = text.replace(',', '.').toDouble();
        changeStep([&](MacroStep &step) { step.pause_s = qBound(0.0, pause_s, MacroStep::longestPause_s); });
    });
    connect(pause_, &QLineEdit::editingFinished, this, &ButtonsEditor::showTexts);
    connect(up, &QToolButton::clicked, this, [this] { moveStep(-1); });
    connect(down, &QToolButton::clicked, this, [this] { moveStep(1); });
    connect(remove, &QToolButton::clicked, this, &ButtonsEditor::removeStep);
    QLayout *const line = inRow(
        {up, down, remove, Part::room(), new PlainLabel(tr("then wait")), pause_, new PlainLabel(tr("s"))});
    return filled(new QWidget, inColumn({name_, {steps_, 1}, line}));
}

QWidget *ButtonsEditor::makeStep() {
    about_ = named(new PlainLabel, "aboutStep");
    about_->letWrap();
    form_ = new SchemaForm;
    QScrollArea *const scroll = scrolled(filled(new QWidget, inColumn({about_, {form_, 1}})));
    scroll->setFocusPolicy(Qt::NoFocus);
    notKept_ = named(new MessageLabel, "stepNotKept");
    connect(form_, &SchemaForm::edited, this, [this] {
        if (form_->isValid()) // what is wrong is not kept
            changeStep([this](MacroStep &step) { takeParameters(step); });
    });
    return filled(new QWidget, inColumn({{scroll, 1}, notKept_})); // where no row moves with it
}

int ButtonsEditor::button() const {
    return list_->currentRow();
}

int ButtonsEditor::step() const {
    return steps_->currentRow();
}

template <typename Change>
void ButtonsEditor::changeMacro(Change change) {
    if (button() < 0)
        return;
    Macro macro = buttons_.all()[std::size_t(button())];
    change(macro);
    isChanging_ = true;
    buttons_.set(button(), macro);
    isChanging_ = false;
}

template <typename Change>
void ButtonsEditor::changeStep(Change change) {
    if (step() >= 0)
        changeMacro([&](Macro &macro) { change(macro.steps[std::size_t(step())]); });
}

void ButtonsEditor::takeParameters(MacroStep &step) {
    MacroStep changed = step;
    changed.params = form_->values();
    const QString problem = changed.problem();
    if (problem.isEmpty())
        step = changed;
    else
        notKept_->tell(tr("This change is not kept. %1").arg(problem), true);
    notKept_->setVisible(!problem.isEmpty());
}

void ButtonsEditor::choose(int place) {
    list_->setCurrentRow(place);
    showSteps();
}

void ButtonsEditor::nameIt() {
    name_->setFocus();
    name_->selectAll();
}

void ButtonsEditor::showAll() {
    QStringList names;
    for (const Macro &macro : buttons_.all())
        names.append(shortLine(macro.name));
    fill(*list_, names, std::max(button(), 0));
    showSteps();
}

void ButtonsEditor::showSteps() {
    const bool isChosen = button() >= 0;
    const Macro macro = isChosen ? buttons_.all()[std::size_t(button())] : Macro();
    QStringList titles;
    for (const MacroStep &one : macro.steps)
        titles.append(shortLine(one.title()));
    fill(*steps_, titles, std::max(step(), 0));
    showStep();
}

/// Name and pause as they are kept.
void ButtonsEditor::showTexts() {
    const Macro macro = button() >= 0 ? buttons_.all()[std::size_t(button())] : Macro();
    name_->setText(macro.name);
    pause_->setText(step() >= 0 ? numberText(macro.steps[std::size_t(step())].pause_s) : QString());
}

void ButtonsEditor::showStep() {
    const bool isChosen = button() >= 0 && step() >= 0;
    const MacroStep step =
        isChosen ? buttons_.all()[std::size_t(button())].steps[std::size_t(this->step())] : MacroStep();
    showTexts();
    const DaemonLink *const daemon = isChosen ? step.target(fleet_) : nullptr;
    const bool isKnown = daemon && daemon->hasMethod(step.method);
    const QJsonObject method = isKnown ? daemon->method(step.method) : QJsonObject();
    about_->setText(
        !isChosen ? tr("A button is made with a command: by Add as a button, beside Run.")
        : isKnown ? method["summary"].toString()
        : !daemon ? tr("%1 of %2 is away: its parameters cannot be changed now.").arg(step.daemon, step.robot)
                  : tr("%1 has no %2 now.").arg(step.daemon, step.method));
    notKept_->hide();
    form_->setSchema(parametersOf(method), {});
    if (isKnown) {
        const QSignalBlocker silence(form_);
        form_->edit(step.params);
    }
    update();
}

void ButtonsEditor::update() {
    const int buttons = list_->count(), steps = steps_->count();
    listTools_[0]->setEnabled(button() > 0);
    listTools_[1]->setEnabled(button() >= 0 && button() + 1 < buttons);
    listTools_[2]->setEnabled(button() >= 0);
    stepTools_[0]->setEnabled(step() > 0);
    stepTools_[1]->setEnabled(step() >= 0 && step() + 1 < steps);
    stepTools_[2]->setEnabled(steps > 1); // the last one goes with its button
    name_->setEnabled(button() >= 0);
    pause_->setEnabled(step() >= 0);
}

void ButtonsEditor::moveStep(int by) {
    const int from = step(), to = from + by;
    changeMacro(
        [&](Macro &macro) { std::swap(macro.steps.at(std::size_t(from)), macro.steps.at(std::size_t(to))); });
    showSteps();
    steps_->setCurrentRow(to);
}

void ButtonsEditor::removeStep() {
    changeMacro([this](Macro &macro) { macro.steps.erase(macro.steps.begin() + step()); });
    showSteps();
}

} // namespace hermes::desktop
