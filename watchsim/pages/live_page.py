"""What is on the page that follows a scene? The page of a run, and a panel that says what changed and takes changes."""

from __future__ import annotations

from watchsim.pages.html import Markup, element, page


def live_page(title: str, token: str) -> str:
    """The page as text; what it shows comes later, from the server that it came from, which asks for the token."""
    places = dict.fromkeys(("poster", "verdict", "sheet", "saved"), Markup(""))
    return page(title, {**places, "lead": "Computing …", "made": "watchsim live"}, None, _desk(token))


def _desk(token: str) -> Markup:
    """The panel beside the picture."""
    buttons = (
        _button("undo", "Undo", "Take back the last change made here (Z)", disabled="disabled"),
        _button("hold", "Hold", "Go on comparing with the same result (H)", aria_pressed="false"),
        _button("ghosts", "Ghost", "The old outline over the new one (G)", aria_pressed="true"),
    )
    head = element("p", "Starting …", id="doing", role="status")
    return element(
        "section",
        element("h2", "What changed", id="h-desk"),
        element(
            "div", head, element("div", *buttons, class_="buttons", role="group", aria_label="Comparing"), class_="deskhead"
        ),
        element("div", id="faults", role="alert", hidden="hidden"),
        element("div", id="outcome"),
        _drawer("knobs", "Dimensions of the design", open="open"),
        _drawer("values", "Numbers of the scene"),
        id="desk",
        aria_labelledby="h-desk",
        data_token=token,
        class_="live",
    )


def _button(name: str, text: str, title: str, **more: str) -> Markup:
    return element("button", text, type="button", id=name, title=title, **more)


def _drawer(name: str, text: str, **more: str) -> Markup:
    return element("details", element("summary", text), element("div", id=name), hidden="hidden", class_="drawer", **more)
