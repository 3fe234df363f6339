#pragma once

#include "gui/desktop/widgets/PlainLabel.h"

namespace hermes::desktop {

/// A line across the window, for what is not to be missed; without text it is hidden.
class Banner : public PlainLabel {
    Q_OBJECT
public:
    explicit Banner(QWidget *parent = nullptr);

    /// style: colours, as a style sheet names them.
    void tell(const QString &text, const QString &style);

Q_SIGNALS:
    void shown(bool isShown);

protected:
    void resizeEvent(QResizeEvent *event) override;

private:
    void fitHeight();
};

} // namespace hermes::desktop
