#pragma once

#include "gui/desktop/model/Macro.h"

#include <QWidget>
#include <array>

class QLineEdit;
class QListWidget;
class QToolButton;

namespace hermes::desktop {

class MessageLabel;
class PlainLabel;
class SchemaForm;

/// The operator's buttons to be named, ordered, removed; and the commands of the chosen one, with their
/// order, parameters and pauses. What is changed is kept at once.
class ButtonsEditor : public QWidget {
    Q_OBJECT
public:
    ButtonsEditor(const Fleet &fleet, Buttons &buttons, QWidget *parent = nullptr);
    /// Shows that button.
    void choose(int place);
    /// Its name is to be typed next.
    void nameIt();

Q_SIGNALS:
    /// Back to where commands are run and added.
    void closed();

private:
    QWidget *makeList();
    QWidget *makeSteps();
    QWidget *makeStep();
    std::array<QToolButton *, 3> makeTools(const QString &name, const QString &up, const QString &down,
                                           const QString &remove);
    void showAll();
    void showSteps();
    void showStep();
    void showTexts();
    void update();
    void moveStep(int by);
    void removeStep();
    /// What is typed, where it can be kept; else says why not.
    void takeParameters(MacroStep &step);
    template <typename Change>
    void changeMacro(Change change);
    template <typename Change>
    void changeStep(Change change);
    int button() const;
    int step() const;

    const Fleet &fleet_;
    Buttons &buttons_;
    bool isChanging_ = false; // by this editor
    QListWidget *list_, *steps_;
    QLineEdit *name_, *pause_;
    PlainLabel *about_;
    MessageLabel *notKept_;
    SchemaForm *form_;
    std::array<QToolButton *, 3> listTools_, stepTools_;
};

} // namespace hermes::desktop
