#pragma once

#include <QDialog>

class QTextBrowser;

namespace hermes::desktop {

/// The manual of the window, docs/desktop.md, in a window of its own that holds up nothing.
class HelpWindow : public QDialog {
    Q_OBJECT
public:
    explicit HelpWindow(QWidget *parent);

    /// Shows the first place that has this text, else the beginning.
    void showAt(const QString &text);

private:
    QTextBrowser *text_;
};

} // namespace hermes::desktop
