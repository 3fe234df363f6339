#pragma once

#include "gui/desktop/model/Macro.h"
#include "gui/desktop/widgets/SecondPress.h"

#include <QPointer>
#include <QWidget>

class QLineEdit;
class QListWidget;
class QPlainTextEdit;
class QPushButton;
class QStackedWidget;

namespace hermes::desktop {

class ButtonsEditor;
class PlainLabel;
class SchemaForm;

/// Any method of the chosen daemon: a form for its parameters, a call, the answer. What replaces or forgets
/// something needs a second press. A command can be made a button of one's own, or a step of one; these are
/// changed on a page of this panel.
class CommandsPanel : public QWidget {
    Q_OBJECT
public:
    CommandsPanel(Fleet &fleet, Buttons &buttons, QWidget *parent = nullptr);
    /// Brings the page to the front on which buttons are changed.
    void editButtons();

private:
    void follow(DaemonLink *daemon);
    void listMethods();
    void showMethod(const QString &name);
    void call();
    void update();
    QWidget *makeMethods();
    QWidget *makeCall();
    QLayout *makeActions();
    std::optional<MacroStep> typedStep();
    void addButton();
    void addStep(int place);
    void offerSteps();

    Fleet &fleet_;
    Buttons &buttons_;
    QPointer<DaemonLink> daemon_;
    QStackedWidget *pages_;
    ButtonsEditor *editor_;
    PlainLabel *title_, *summary_;
    QLineEdit *filter_;
    QListWidget *methods_;
    SchemaForm *form_;
    QPushButton *call_, *addButton_, *addStep_;
    QPlainTextEdit *answer_;
    QString method_; ///< empty: none is chosen
    SecondPress second_;
};

} // namespace hermes::desktop
