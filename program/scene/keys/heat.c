/* Keys of scenes with temperatures. */
#include "scene/keys.h"

static const char PAGE[] = "c_examples/scenes/heat.md";

static const Key HEAT[] = {
  {"initial", KEY_NUMBER, "K", ANY, REQUIRED, "the temperature of all bodies at the start"},
  {"coupling", KEY_WORD, "one_way two_way", ANY, "one_way",
   "`one_way`: the mechanics decides what heat meets. `two_way`: bodies expand, too, and each step is repeated in turns until the temperatures "
   "settle"},
  {"tolerance", KEY_NUMBER, "", ABOVE(0), "1e-9",
   "of `two_way`: a step has settled where a turn changes no temperature by more than this part of their range"},
  {"turns", KEY_WHOLE, "", FROM(1), "50", "of `two_way`: after so many a step has failed and is cut back"},
};

static const Key BODIES[] = {
  {"conductivity", KEY_NUMBER, "F/(T K)", ABOVE(0), "", "a body without keeps its initial temperature: it takes and gives any heat"},
  {"heat_capacity", KEY_NUMBER, "F/(L^2 K)", FROM(0), "0",
   "of its volume: specific heat times density. Without it the body is stationary in each step. Over time by the implicit Euler method. Of a tool, "
   "which is a rigid body or an analytic one, of the whole tool [F L/K]: see below"},
  {"expansion", KEY_NUMBER, "1/K", ANY, "0",
   "with `two_way`: strain for each degree above the initial temperature, alpha. Of finite strain the body would grow by theta = 1 + alpha (T - "
   "T_0) in all directions, F = theta F_e, and has Cauchy's stress of F_e: its energy is theta^3 W(F_e). Heat is conducted in the body as it was. "
   "With `dynamics` of bodies of the material `linear` alone"},
};

static const Key TEMPERATURES[] = {
  {"surface", KEY_NAME, "name or list of surfaces", ANY, REQUIRED, "that of an analytic body stands for all of it"},
  {"value", KEY_NUMBER, "K", ANY, REQUIRED, "the temperature. Two that share a vertex must say the same there; its heat counts with the later one"},
  {"curve", KEY_CURVE, "", ANY, "a ramp over the run", "the factor over time on what it is above the initial one"},
};

static const Key FLOWS[] = {
  {"surface", KEY_NAME, "name or list of surfaces", ANY, REQUIRED, "where heat comes in"},
  {"flow", KEY_NUMBER, "F/(L T)", ANY, REQUIRED, "for each area and time"},
  {"curve", KEY_CURVE, "", ANY, "a ramp over the run", "a factor over time"},
};

static const Key INTERFACES[] = {
  {"conductance", KEY_NUMBER, "F/(L T K)", FROM(0), "0",
   "at `conductance_pressure`; it goes with the pressure to the power of `conductance_exponent`"},
  {"conductance_pressure", KEY_NUMBER, "F/L^2", ABOVE(0), "", "where `conductance` is meant"},
  {"conductance_exponent", KEY_NUMBER, "", ABOVE_TO(0, 2), "0.95", "of the pressure"},
  {"conductance_constant", KEY_NUMBER, "F/(L T K)", FROM(0), "0", "at any pressure, while the gap is within `conductance_reach`"},
  {"gap_conductivity", KEY_NUMBER, "F/(T K)", FROM(0), "0",
   "what fills the gap conducts as this over gap plus `gap_distance`, within `conductance_reach`"},
  {"gap_distance", KEY_NUMBER, "L", ABOVE(0), "", "the gap that touching surfaces count as"},
  {"conductance_reach", KEY_NUMBER, "L", ABOVE(0), "",
   "the gap from which on `conductance_constant` and `gap_conductivity` pass nothing; they fade over its last tenth. Required with either of them"},
  {"friction_heat", KEY_NUMBER, "", WITHIN(0, 1), "", "the non-mortar body's share of the heat of friction; without it friction makes none"},
};

const KeyTable KEYS_HEAT[] = {
  KEY_TABLE("heat", "heat", "Heat", PAGE, HEAT),
  KEY_TABLE("heat-of-bodies", "bodies", "Heat of bodies", PAGE, BODIES),
  KEY_TABLE("temperatures", "temperatures", "Temperatures", PAGE, TEMPERATURES),
  KEY_TABLE("flows", "flows", "Flows of heat", PAGE, FLOWS),
  KEY_TABLE("heat-across", "interfaces", "Heat across interfaces", PAGE, INTERFACES),
  KEY_TABLES_END};
