// The REST interface in words, from the server's own OpenAPI document.
import { get } from "./server.js";
import { el } from "./format.js";

const document_ = await get("/openapi.json");
document.getElementById("about").textContent = document_.info.description;
document.getElementById("operations").replaceChildren(
  ...Object.entries(document_.paths).flatMap(([path, methods]) => Object.entries(methods).map(([method, it]) => article(method, path, it))),
  article("ws", "/live", { description: "WebSocket: states (stand, experiment, job, runs, dropped) and blocks of decimated samples." }));

function article(method, path, operation) {
  return el("article", {}, el("h3", {}, el("span", { class: "method" }, method.toUpperCase()), ` ${path}`),
    el("p", {}, operation.description || operation.summary || ""), ...examples(operation));
}

function examples(operation) {
  const schema = resolve(operation.requestBody?.content?.["application/json"]?.schema);
  const found = schema?.examples || (schema?.properties ? [sample(schema)] : []);
  return found.map((example) => el("pre", {}, JSON.stringify(example, null, 1)));
}

function resolve(schema) {
  return schema?.$ref ? document_.components.schemas[schema.$ref.split("/").at(-1)] : schema;
}

function sample(schema) {
  return Object.fromEntries(Object.entries(schema.properties).filter(([, each]) => each.examples).map(([name, each]) => [name, each.examples[0]]));
}
