// Plays the flight over and over, keeps the view while it plays, and turns two birds together.
(function () {
  const flight = document.getElementById("{plot_id}");
  const scenes = Object.keys(flight._fullLayout).filter((key) => /^scene\d*$/.test(key));
  const [play] = flight.layout.updatemenus[0].buttons;
  const last = flight.layout.sliders[0].steps.length - 1;
  let again = true;

  function start(fromCurrent) {
    Plotly.animate(flight, null, { ...play.args[1], fromcurrent: fromCurrent }).catch(() => {});
  }

  flight.on("plotly_buttonclicked", ({ button }) => {
    again = button.label === play.label;
    if (again && flight._fullLayout._currentFrame === String(last)) start(false);
  });
  flight.on("plotly_sliderstart", () => { again = false; });
  flight.on("plotly_animated", () => {
    // Only once plotly has ended its own loop, which would end the new one too.
    if (again && flight._fullLayout._currentFrame === String(last)) setTimeout(start, 0, false);
  });

  // A drag is known to the figure only once it ends; a frame drawn before would undo it.
  function keep(change) {
    const turned = scenes.find((name) => change[name + ".camera"]);
    if (!turned) return;
    for (const name of scenes) {
      flight.layout[name].camera = change[turned + ".camera"];
      flight._fullLayout[name].camera = change[turned + ".camera"];
      if (name !== turned) flight._fullLayout[name]._scene.setViewport(flight._fullLayout[name]);
    }
  }
  flight.on("plotly_relayouting", keep);
  flight.on("plotly_relayout", keep);
  start(true);
})();
