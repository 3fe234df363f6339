#pragma once

#include "gui/desktop/model/MacroRunner.h"
#include "gui/desktop/widgets/SecondPress.h"

#include <QWidget>

class QBoxLayout;
class QPushButton;

namespace hermes::desktop {

class PlainLabel;

/// The operator's own buttons in one line, and how far the one goes that runs. What replaces or forgets
/// something needs a second press.
class ButtonBar : public QWidget {
    Q_OBJECT
public:
    ButtonBar(Fleet &fleet, const Buttons &buttons, MacroRunner &runner, QWidget *parent = nullptr);

Q_SIGNALS:
    /// They are to be changed.
    void editWanted();

private:
    void rebuild();
    void update();
    void press(int place);
    void tell(const QString &text, Condition condition);

    const Buttons &buttons_;
    MacroRunner &runner_;
    SecondPress second_;
    int asked_ = -1; ///< which one is to be pressed a second time
    QBoxLayout *line_;
    std::vector<QPushButton *> made_;
    QPushButton *end_;
    PlainLabel *text_;
    QTimer refresh_; // many changes are shown once
};

} // namespace hermes::desktop
