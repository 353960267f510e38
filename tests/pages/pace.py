"""How fast does a page's player draw, and what does that take of a processor?"""

from typing import Any, NamedTuple

SIZE = (1280, 720)
WHOLE = f"#picture {{ position: fixed; inset: 0; width: {SIZE[0]}px; height: {SIZE[1]}px; border: 0; z-index: 9 }}"
COUNT = """seconds => new Promise((done) => {
  const begun = performance.now(), drawn = [];
  const step = (now) => {
    drawn.push(watchsim.pace().drawn);
    now - begun < 1000 * seconds ? requestAnimationFrame(step) : done([drawn, (now - begun) / 1000]);
  };
  requestAnimationFrame(step);
})"""


class Played(NamedTuple):
    """frames drawn in `seconds` of wall time; processor time of scripts and of the main thread as a whole, s; and the median
    wall time (ms) that a frame took to draw."""

    frames: int
    seconds: float
    drawing: float
    busy: float
    median: float


def played(page: Any, seconds: float) -> Played:
    """Play the picture alone, 1280 × 720 pixels with contacts and forces, for some seconds."""
    page.add_style_tag(content=WHOLE)
    page.keyboard.press("f")
    page.wait_for_timeout(300)
    page.keyboard.press("Space")
    page.wait_for_timeout(300)
    session = page.context.new_cdp_session(page)
    session.send("Performance.enable", {"timeDomain": "threadTicks"})

    def spent() -> dict[str, float]:
        return {one["name"]: one["value"] for one in session.send("Performance.getMetrics")["metrics"]}

    before = spent()
    drawn, took = page.evaluate(COUNT, seconds)
    after = spent()
    scripts, busy = (after[name] - before[name] for name in ("ScriptDuration", "TaskDuration"))
    return Played(len(drawn), took, scripts, busy, sorted(drawn)[len(drawn) // 2])
