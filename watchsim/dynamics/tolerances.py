"""Up to where is a number of the contact problems zero, or equal to another one?

All are shares, without unit: problems are scaled before they are solved. `Large` and `small` say what goes wrong when a
tolerance is too large or too small.
"""

from __future__ import annotations

# --- Linear systems ---

# Of the first pivot: smaller ones are zero, forces then not unique. Large: stiff pairs merge; small: forces of rounding.
RANK = 1e-11

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

# --- Contact forces and modes ---

# Of its terms: an acceleration that small is zero. Large: late detachment; small: rounding decides.
ACCELERATION_ROUNDING = 1e-11
# Of G_N: a sliding contact pushed less open by its force is jammed. Large: jams early; small: huge forces.
PAINLEVE = 1e-9
# Of the fastest slip: one that slow has no direction. Large: mirror images differ; small: rounding takes sides.
NO_HAND = 1e-9
# Of the largest force: by so much a law may be missed. Large: forces that pull; small: needless searches.
LAW_SLACK = 1e-9
# What a free direction of length one does for a law by rounding. Large: laws unmet; small: boundless forces.
LAW_ROUNDING = 1e-11
# Of its square: what is left of a vector that depends on others. Large: free directions lost; small: noise kept.
DEPENDENT = 1e-20

# --- Impacts ---

# Of its terms: a rate that small is zero. Large: slow approaches are missed; small: noise contradicts itself.
VELOCITY_ROUNDING = 4e-15
# Sine² of the angle between parallel directions. Large: slanted ones pass; small: friction stays open.
PARALLEL = 1e-12
# Of the slip: approach by which the force of a jammed contact acts. Large: others carry it; small: below rounding.
NUDGE = 1e-6
# Of the friction cone: a tangential impulse that small has no sign. Large: pg1996 is blunted; small: rounding.
NO_TANGENTIAL = 1e-10

# --- Forces over time ---

# Of the time: a knot of a table that close has been passed. Large: knots skipped; small: steps of length zero.
KNOT_ROUNDING = 1e-15
