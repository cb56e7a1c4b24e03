// What is shown: facts and arrays hold speeds and frequencies over f₁(0), and lengths over the gap.
const UNITS = {
  engine: {
    speed: { scale: 60 * facts.f1_Hz, name: "speed (rpm)", text: (value) => `${value.toFixed(0)} rpm` },
    frequency: { scale: facts.f1_Hz, name: "frequency (Hz)", text: (value) => `${value.toFixed(1)} Hz` },
    length: { scale: facts.gap_um, name: "(µm)", text: (value) => `${plain(value)} µm` },
  },
  norms: {
    speed: { scale: 1, name: "Ω / f₁(0)", text: (value) => `${value.toFixed(3)} f₁(0)` },
    frequency: { scale: 1, name: "f / f₁(0)", text: (value) => `${value.toFixed(2)} f₁(0)` },
    length: { scale: 1, name: "/ gap", text: (value) => `${plain(value)} gaps` },
  },
};
let units = UNITS[facts.norms ? "norms" : "engine"];

// A number with so many digits, without an exponent.
function plain(value, digits = 3) {
  return value.toLocaleString("en", { maximumSignificantDigits: digits });
}

const shown = (of, value) => units[of].scale * value; // a value, in its unit
const said = (of, value) => units[of].text(shown(of, value)); // with its unit
const scaled = (of, values) => Array.from(values, (value) => shown(of, value));
const length = (name) => `${name} ${units.length.name}`; // of an axis
