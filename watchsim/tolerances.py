"""Up to where is something zero, the same, or at the same time, in a run?

Each has its unit or what it is a share of, what it is for, and what goes wrong when it is too large or too small. Contact
problems are scaled before they are solved, so theirs are all shares. The event loop's begin with those of `Options`, which
scale with the scene's size (simulation/options.py). Readers of drawings have their own, and so has what is turned by hand.
"""

from __future__ import annotations

# ====== Outlines, and which of them could touch ======

# Of the scene's size: what joints of outlines leave open. Large: steps count as smooth; small: rounding makes edges.
JOINT_RESOLUTION = 3e-11
# m. Six decimals of a millimetre place a point within 0.71 nm, two outlines within 1.41 nm of each other; position and angle of
# a body add their own. Large: a contact begins where none was drawn; small: resting contacts are refused.
DRAWING_ROUNDING = 2e-9
# m: sizes of scenes beyond which that, and what is looked at more finely than it, goes with the size. Large, small: as above.
SMALLEST_DRAWN, LARGEST_DRAWN = 1e-3, 1.0
# Of the size, more than any tolerance of a run: a pair that comes this close can touch. Large: more candidates; small: contacts
# are lost.
CLEARANCE = 2e-3
# Of a distance: the coordinates that shapely is given are rounded. Large: more candidates; small: contacts are lost.
PLANE_ROUNDING = 1e-9
# Of the distances from which a place is computed. Large, small: as above.
PLACE_ROUNDING = 1e-14

# ====== Contact problems ======

# --- Linear systems ---

# Of the first pivot: smaller ones are zero, forces then not unique. Large: stiff pairs merge; small: forces of rounding.
RANK = 1e-11

# --- Loads of bearings, as shares of their friction ---

# What still changes when the iteration ends. Large: forces and friction contradict each other; small: rounds of rounding.
LOAD_SETTLED = 1e-13
# The same after all rounds, where redundant or nearly singular forces are known to no more. Large: what jams passes; small:
# what does not is refused.
LOAD_ROUGH = 1e-9

# --- Complementarity problems, in the scaling of lcp/scaling.py ---

# Of unit diagonals: mutual coefficients left by rounding. Large: units misjudged; small: noise scales rows.
COEFFICIENT_ROUNDING = 1e-14
# A pivot that small is zero. Large: solvable problems end on a ray; small: division by rounding.
LCP_PIVOT = 1e-11
# Of the load that drives a problem: ratios that close are equal. Large: a wrong row leaves; small: at 1e-12 1 in 1000 singular
# problems ends on a ray.
RATIO_TIE = 1e-10
# Of the largest load: the same. Large: small approaches tie with none; small: rounding takes sides.
LOAD_ROUNDING = 1e-15
# Of the load that drives it: changes of loads that part ties. Large: another problem is solved; small: ties stay.
LCP_PERTURBED = 1e-4
# Of that: the same on the next path. Large, small: too few sizes are tried.
LCP_LESS = 0.1
# Of its terms: a y that small is zero. Large: wrong solutions pass; small: right ones are refused.
LCP_RESIDUAL = 1e-9
# Of the largest x, or of one: so is that. Large: small forces vanish; small: redundant sets are refused.
LCP_ROUNDING = 1e-13
# Of what drives the problem: the same where loads are rounding, as the last resort. Large, small: as above.
LCP_ROUGH = 1e-9
# The same where that is not enough: in heaps of tens of bodies. Large, small: as above.
LCP_ROUGHEST = 1e-6
# Other paths of Lemke's method; unknowns (2^12 eliminations take milliseconds) and sets of modes (some tenths of a second) up
# to which all are tried after these. Large: a problem without solution takes long; small: one that has one ends the run.
LCP_PATHS, LCP_ENUMERATED, MODE_SETS = 8, 12, 50000
# Sweeps that make the largest coefficients of rows and columns alike. Large: slower; small: units misjudged.
SCALING_SWEEPS = 3

# --- Contact forces and modes ---

# Of its terms: an acceleration that small is zero. Large: late detachment; small: rounding decides.
ACCELERATION_ROUNDING = 1e-11
# Of a spring stretched by the size: the force whose rounding is that of a spring at rest, `GAP_ZERO` of the size. Large: late
# detachment where a spring passes its rest; small: rounding of the place decides there.
SPRING_AT_REST = 1e-3
# Of G_N: a sliding contact pushed less open by its force is jammed. Large: jams early; small: huge forces.
PAINLEVE = 1e-5
# Of that: where a step ends. Near 1: rounding may then find the contact not yet jammed; small: huger forces.
PAINLEVE_WATCHED = 0.9
# Of the fastest slip: one that slow has no direction. Large: mirror images differ; small: rounding takes sides.
NO_DIRECTION = 1e-9
# Of the largest force: by so much a law may be missed. Large: forces that pull; small: needless searches.
LAW_SLACK = 1e-9
# Of the force at which a mode ends: by so much laws may be missed that leave no forces at all, less than `BEGIN_SLACK`.
# Large: a mode that has ended starts again; small: modes end where time cannot go on.
LAW_SHARE = 0.25
# What a free direction of length one does for a law by rounding. Large: laws unmet; small: boundless forces.
LAW_ROUNDING = 1e-11
# Of its square: what is left of a vector that depends on others. Large: free directions lost; small: noise kept.
DEPENDENT = 1e-20

# --- Impacts ---

# Of its terms: a rate that small is zero. Large: slow approaches are missed; small: noise contradicts itself.
VELOCITY_ROUNDING = 4e-15
# Sine² of the angle between parallel directions. Large: slanted ones pass; small: friction stays open.
PARALLEL = 1e-12
# The same where friction locks bodies. Large: these stop too soon; small: problems of rounding rank.
DEAD_CENTRE = 1e-10
# Of the speeds of bodies, over their reach: spins that small may be rounding of either, squared. Large: slow turns part late;
# small: rounding makes forces.
SPIN_ROUNDING = 1e-9
# Of the slip: approach by which the force of a jammed contact acts. Large: others carry it; small: below rounding.
NUDGE = 1e-6
# Of the friction cone: a tangential impulse that small has no sign. Large: pg1996 is blunted; small: rounding.
NO_TANGENTIAL = 1e-10

# --- Forces over time ---

# Of the time: a knot of a table that close has been passed. Large: knots skipped; small: steps of length zero.
KNOT_ROUNDING = 1e-15

# ====== The event loop ======

# --- Options of a run ---

# Relative error of a step that may be requested. Large: errors show in every number; small: below the rounding of a step.
FINEST_TOLERANCE, COARSEST_TOLERANCE = 1e-13, 1e-2
# Of the size: a gap that small is zero to rounding. Large: early contacts; small: below the rounding of positions.
GAP_ZERO = 1e-13
# Of the size: gaps that small take part in an impact. Large: merges events; small: splits simultaneous ones.
GAP_CLOSE = 2e-10
# Of the size: `behind`; the largest is `sunk`. Large: accepts contacts on the far side, and more looks; small: falls through.
BEHIND_LEAST, BEHIND_MOST = 2e-8, 2e-5
# Of the size, for each of the tolerance: drift lets a corner land so far behind. Large, small: as above.
BEHIND_PER_TOLERANCE = 20.0
# Times the joint of outlines: `extent`. Large: contacts stick out; small: they slip through joints.
EXTENT_PER_JOINT = 4.0
# Of the size per unit of time: slower is zero. Large: freezes slow sliding; small: below the rounding of velocities.
SPEED_ZERO = 1e-8
# The same, for each of the tolerance: velocities drift that much in a step. Large, small: as above.
SPEED_PER_TOLERANCE = 20.0
# The most of it: a faster slip reverses at every tolerance. Large: reversals are missed; small: drift counts.
COARSEST_SPEED_ZERO = 2e-7
# Of a contact's force terms. Large: late detachment; small: rounding decides.
FORCE_ZERO = 1e-10
# rad of the scene's slowest spring (of what its forces, else its velocities do, where there is none): the scene's own unit of
# time, in which all tolerances count. Large, small: as those.
UNIT_PHASE = 10.0
# Of the rate of the fastest spring: slower ones do not count for that. Large: freezes what is slow; small: below rounding.
SLOWEST_RATE = 1e-2
# Of the unit of time: rebounds that would end sooner are ended by rule. Large: changes timing; small: more impacts.
ACCUMULATION_TIME = 1e-6
# Of the size per unit of time: faster rebounds are never ended by rule. Large: changes timing; small: more impacts.
ACCUMULATION_SPEED = 0.1
# Of a coordinate's force terms: less accelerates nothing. Large: creeping bodies freeze; small: nothing ever sleeps.
SLEEP = 1e-9
# Of that: the same where contacts allow the acceleration, which is then no rounding of their forces. Large: unstable rest
# lasts; small: rounding ends it.
SLEEP_LOOSE = 1e-4
# Of the largest gap acceleration that bodies could have: less is allowed by a contact. Large: rounding wakes; small: unstable
# rest lasts.
LOOSE = 1e-2
# Of the scale times its rate: what is slower is followed more closely, in proportion, to `SLOW_ERROR` of the scale. Large: more
# steps; small: what leaves an unstable rest leaves at the wrong time.
SLOW, SLOW_ERROR = 1e-3, 1e-14
# rad of the fastest oscillation between rows. Large: rates between rows off; small: long tables.
FINEST_ROWS, COARSEST_ROWS = 0.0125, 0.1

# --- Time ---

# Of the longest step: the first one tried. Large: rejected at once; small: some more steps.
FIRST_STEP = 1e-3
# Of the longest step: shorter, the run ends. Large: ends at sharp forces; small: hangs there.
SMALLEST_STEP = 1e-14
# Sizes of the scene, or radians: the longest flight. Large: a step of what runs away takes for ever; small: more steps.
FLIGHT_SIZES = 1e4
# Sizes of the scene, or radians: further away a position is rounded to a millionth of the size. Large: what runs away is
# followed for ever; small: long falls and fast wheels end.
FURTHEST_SIZES = 1e10
# Of the time within a step: less is no progress. Large: contacts close late; small: the search stands still.
TIME_ROUNDING = 4e-16
# Of the time: bounds that close are one instant. Large: modes end late; small: needless evaluations.
ROOT_RESOLUTION = 1e-15
# Of the time: the same for turning points and passages, whose times make the rate. Large: jitter; small: needless
# evaluations.
PASSAGE_RESOLUTION = 1e-16
# tolerances: defect of a step's extension. Its path is off by a fifth of that: in lever scenes by 2 at most, in a step that has
# grown too fast by 200. Large: contacts close early or late; small: needless steps.
DEFECT = 10.0
# tolerances: share of the kinetic energy by which the energy on a step's path may miss the work done on it, where forces go
# with loads, slips or a case that moves; and rounding of both. Large: a ledger that opens where events cut long steps; small:
# short steps.
LEDGER_OF_PATH, LEDGER_ROUNDING = 1e-3, 7e-15
# Of the step that errors allow: the shortest that the ledger may ask for.
LEAST_FOR_LEDGER = 1.0 / 64.0
# rad of the fastest coordinate's own time scale: the longest flight. Large: longer buffers; small: more steps.
FLIGHT_PHASE = 1.6
# Events within an instant, and impacts and decisions in a row at one event, at most. Large: hangs; small: ends runs.
EVENTS_AT_ONCE, ROUNDS = 2000, 64
# Of `accumulation_time`: events that close count as at once. Large: ends runs; small: hangs where time stands.
SAME_INSTANT = 1e-3

# --- Time of impact ---

# m/s: in place of a bound that is zero, to be divided by. Large: closes late; small: division by zero.
SLOWEST_CLOSING = 1e-300
# Of what is left of a step: shorter looks deserve the finer bound. Large: dearer looks; small: more of them.
FINE_LOOK = 1.0 / 64.0
# Of the extent: steps in which a neighbour of a contact in force is watched. Large: late; small: slow.
NEIGHBOUR_STRIDE = 0.25
# Sine² of the angle between face and motion, drawings being rounded to a millionth. Large: falls through; small: jams.
IMMOVABLE = 1e-12
# Extents before the end of a primitive: where forces are read again. Large: a pull before is not seen; small: beyond the end.
WITHIN_ENDS = 8.0

# --- Contacts that pass from primitive to primitive, in `extent`s or rad ---

# Extents beyond its end: between 1, where touching ends, and 2, the monitor. Large: never left; small: left at once.
LEFT_PRIMITIVE = 1.5
# Extents: contact points that close are one. Large: merges contacts; small: impacts at smooth joints.
NEAR_POINTS = 100.0
# Extents: points further apart are two, however far the normal may turn. Large: merges; small: impacts at shallow joints.
FAR_POINTS = 1e4
# rad. Large: shallow corners count as smooth; small: drawings tangent to a nanometre only get impacts.
SMOOTH_TURN = 1e-5
# rad: no joint that turns by more is smooth. Large: corners are smoothed; small: impacts on small fillets.
SHARP_TURN = 1e-2

# --- Velocities that are rounding ---

# Of the terms of a gap rate: less is zero where it must be exact. Large: shallow kinks pass; small: endless impacts.
RATE_ROUNDING = 1e-12
# Of the rate that an impulse takes away: what the impact problem leaves of a zero. Large: slow rebounds go on for ever; small:
# rounding rebounds.
REBOUND_ROUNDING = 1e-10
# rad: normals of outlines turn that much by rounding, which makes gap rates of slips. Large, small: as above.
TILT_ROUNDING = 1e-13
# Of `accumulation_speed`: the same where nothing moves. Large, small: as above.
RATE_FLOOR = 1e-14
# Times that: rates that cannot all be zero. Large: bodies are stopped; small: rounding makes impacts.
CONTRADICTING_RATE = 100.0
# Of `speed_zero`: changes of rates by taken-back gaps that need no second look. Large: drift; small: slower.
RATES_TURNED = 0.1
# Sine² below which a direction is one of the others, in steps. Large: drift piles up; small: rounding grows.
DEPENDENT_IN_STEPS = 1e-6
# The same at events, of rates that count as zero. Large: needless impulses; small: bodies are stopped.
DEPENDENT_AT_EVENTS = 1e-2
# Times `behind`: a way along a face to take back drift, one tolerance of it at 1e-3 rad. Large: bodies jump off the face they
# met; small: they keep drift.
TAKEN_BACK_ALONG = 50.0
# Of slips against gap rates where they compete. Large: gap rates suffer; small: slips drift.
SLIP_WEIGHT = 0.5
# Times `speed_zero`: slips against their direction by less do not end a mode. Large: late; small: modes alternate.
SLIP_SLACK = 2.0

# --- Forces at the end of a mode ---

# Of a step: places at which modes are looked at again where a stage saw one end. Large: slower; small: short ends are missed.
MONITOR_SAMPLES = 8
# Of the gap between the ends of an arc: a contact that may turn by more in a step is looked for there. Large: a notch is passed
# unseen; small: slower.
PASSES_GAP = 0.5
# Times the way in such gaps: places at which modes are then looked at. Large: slower; small: a notch is passed unseen.
LOOKS_PER_GAP = 4.0
# Newton's steps to where a contact closes that drift has closed. Large: slower; small: it closes late, by its drift.
TOUCH_STEPS = 6

# Of the island's largest force: smaller ones have no sign. Large: kept although they pull; small: let go by rounding.
FORCE_NOISE = 1e-14
# Of the slack with which a mode ends: one that has ended does not start again. Large: modes alternate; small: early ends.
BEGIN_SLACK = 0.5
# Times more lenient when modes come back at one instant. Large: coarse terms; small: more rounds.
LENIENCE_STEP = 10.0
# Times more lenient at most where a bearing nearly seizes and no step is made. Large: stops what may go on; small: ends runs.
NEARLY_SEIZED = 1e3
# The most lenient terms. Large: late detachment there; small: the run ends where rounding is large.
MOST_LENIENT = 1e7

# --- Impacts that follow each other ---

# Of the largest impulse of an impact: less is rounding and no event. Large: hidden impacts; small: events by chance.
NO_IMPULSE = 1e-12
# Of the kinetic energy: more is no rounding. Large: energy comes from nowhere; small: restitution cut by rounding.
ENERGY_GAIN = 1e-12
# Times `gap_zero`: lower rebounds are rounding. Large: stops small rebounds; small: goes on by rounding alone.
HIDDEN_REBOUND = 20.0
# That many within `accumulation_time` of each other may be endless. Large: more impacts; small: rows of bodies are stopped.
ENDLESS_REBOUNDS = 1000
# Of the first time between them: endless ones come that soon. Large: what comes back evenly is stopped; small: more impacts.
SHRUNK_PLAY = 0.5
# Of their gap rate: endless ones change by no more. Large: what springs back is stopped; small: losses hide them.
SAME_RATE = 0.1
# Of the kinetic energy spared by friction while contacts are apart. Large: energy appears; small: chatter goes on.
CHATTER_GAIN = 1e-8
# The same where the impact has just taken more. Large: motion of near jams changes; small: chatter goes on.
CHATTER_BACK = 1e-6
# Of the friction cone: sticking stays that far inside. Large: sticking taken for slip; small: rounding decides.
WITHIN_CONE = 1e-9

# --- What a run checks of itself ---

# Of the kinetic energy: corrections may change that much. Large: faults pass; small: sound runs end.
EXPLAINED_SHARE = 1e-6
# The same, of the highest energy met. Large, small: as above.
EXPLAINED_OF_HIGHEST = 1e-12
# Times `speed_zero`: what is no faster may be stopped. Large, small: as above.
STOPPABLE_SPEED = 30.0
# Of the energy turned over: a larger residual is no rounding. Large: faults pass; small: sound runs end.
LEDGER_SHARE = 1e-6
# The same, for each of the tolerance: that was requested. Large, small: as above.
LEDGER_PER_TOLERANCE = 1e3
# tolerances: error of positions at rows, each for itself. Large: bends are smoothed; small: rates between rows ring.
ROW_NOISE = 0.5
# Of the size: overlaps that count, twice `behind` at least. Large: faults pass; small: `behind` is seen.
OVERLAP_RESOLUTION = 5e-5
# Of the size: allowed where time is stepped. Large: coarse steps pass; small: usual ones are refused.
STEPPED_OVERLAP = 5e-3

# --- Overlaps at the start ---

# m: deviation of chords from outlines, where two do not come close and where they do. Large: depths are uncertain; small: slow.
CHORDS_APART, CHORDS_NEAR = 5e-8, 1e-10
# m: chords of two outlines that close are near. Large: slow; small: depths of chords that deviate.
NEAR_CHORDS = 1e-6
# Of half an edge: where it lies deepest. Large: depths are short; small: below rounding.
DEEPEST_PLACE = 1e-12
# rad or m, and per s: that near its rest position a body stands there. Large: one that is let go counts as still; small: one
# that is drawn at rest does not.
HANGS_STILL = 1e-9

# Times the drawing's rounding: gaps of what touches. Large: distant ones are moved; small: touches are missed.
TOUCH_REACH = 1.5
# Times that rounding: moves to take an overlap back. Large: moves by more than rounding; small: refusals.
FURTHEST_TAKEN_BACK = 50.0
# Of a contact's mobility: less across it is none. Large: overlaps stay; small: huge moves.
IMMOBILE = 1e-6
# Of one: residual of a problem without solution. Large: wedges refused early; small: huge moves.
NO_CHANGE_LEFT = 1e-9
# Times `gap_zero`: overlap left. Large: begins with overlaps; small: never ends.
OVERLAP_GONE = 10.0

# --- Moreau's time stepping ---

# Of the largest percussion: change in a sweep. Large: inexact; small: sweeps without end.
SETTLED = 1e-13
# Of a penetration, taken back in a step. Large: bodies are flung apart; small: they sink in.
TAKEN_BACK = 0.2
# Of a contact's own push, for what is wedged in from two sides. Large: sinks in; small: one side gets all.
YIELD = 1e-3
# Of a step: rounding of time. Large: the last step is long; small: one of next to nothing is added.
STEP_ROUNDING = 1e-9
# Of the scale, for each of the tolerance: what the acceleration may do to the way between rows, and 32 times as much to the
# acceleration itself. Large: rates between rows off; small: long tables.
STRAY_PER_TOLERANCE = 32.0

# Of w_N in w_T: on the line of centres, where a force across moves nothing, that is rounding. Friction does not hold a contact
# there, whose slip passes zero. Too small: forces without bound, found for such a slip, stop the solver.
NO_ARM = 1e-13
