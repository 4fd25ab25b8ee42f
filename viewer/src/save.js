// What is seen as a file: one picture, or the run as a video that the browser makes.

/** Offers a file to be saved. */
function offer(blob, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** Saves the view as a picture. draw: draws it; the canvas keeps it no longer than until the browser shows it. */
export function savePicture(canvas, title, draw) {
  draw();
  canvas.toBlob((blob) => offer(blob, `${title}.png`), "image/png");
}

/** A video of the view, from when it is made until stop(). done: what is told of the blob, which is offered. */
export class Video {
  constructor(canvas, title, done = () => {}) {
    const type = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm"].find((each) => (
      window.MediaRecorder?.isTypeSupported(each)));
    if (!type) throw new Error("this browser makes no WebM videos");
    const parts = [];
    this.recorder = new MediaRecorder(canvas.captureStream(30), { mimeType: type, videoBitsPerSecond: 8_000_000 });
    this.recorder.addEventListener("dataavailable", (event) => parts.push(event.data));
    this.recorder.addEventListener("stop", () => {
      const blob = new Blob(parts, { type: "video/webm" });
      offer(blob, `${title}.webm`);
      done(blob);
    });
    this.recorder.start(1000); // a part each second
  }

  stop() { if (this.recorder.state !== "inactive") this.recorder.stop(); }
}
