<story>
<p><emotion name="joy" weight="0.35"/>Rücken Sie ein wenig näher, <gesture name="listen" weight="0.8"/>meine Ohren sind alt; das kommt von den Glocken.
Ich war <gesture name="think" weight="0.6"/>neunundzwanzig, als die Stadt bei mir die <gesture name="large"/><emphasis>größte</emphasis> Glocke im ganzen Tal bestellte.
Jedes Haus gab, <gesture name="explain" weight="0.7"/>was es an Metall hatte: einen Löffel, eine Schnalle, einen zerbrochenen Leuchter.
<emotion name="sadness" weight="0.45"/>Und eine alte Witwe gab ihren <gesture name="small"/>Fingerhut, <break time="300ms"/><prosody rate="90%">denn sonst hatte sie nichts.</prosody></p>

<p><emotion name="joy" weight="0.3"/>Ich lachte und steckte ihn in die Tasche, statt ihn ins Feuer zu werfen.
<look at="fireplace"/>Wir gossen bei Nacht, bei einem Feuer, <gesture name="open_arms"/>das den ganzen Berg erhellte.<look at="visitor"/>
<emotion name="surprise" weight="0.4"/>Am Morgen schlug ich sie zum ersten Mal an, <break time="600ms"/><emotion name="fear" weight="0.45"/><prosody volume="soft" rate="88%">und sie war <gesture name="shake_head" weight="0.6"/>stumm.</prosody>
Kein Ton, nicht einmal ein Scheppern; zwanzig Zentner Bronze, <gesture name="shrug" weight="0.6"/>still wie ein Federbett.
<gesture name="count_three"/>Dreimal schmolz ich sie ein, <break time="200ms"/>und dreimal <emphasis>schwieg</emphasis> sie.</p>

<p><emotion name="sadness" weight="0.5"/>Dann, eines Nachts, griff ich in die Tasche, <break time="350ms"/><prosody rate="88%">und da war der <gesture name="small"/>Fingerhut.</prosody>
<gesture name="sigh"/>Nie im Leben habe ich mich so geschämt.
<emotion name="joy" weight="0.3"/>Also ging ich zu der Witwe und <gesture name="bow" weight="0.7"/>bat sie um Verzeihung, und sie warf ihn mit eigener Hand in das glühende Erz.</p>

<p><emotion name="joy" weight="0.9"/>Und die Glocke <gesture name="wonder"/><emphasis level="strong">klang</emphasis>!
<gesture name="point_up"/>Sieben Dörfer hörten sie, und im siebten, so heißt es, <break time="250ms"/>zog ein tauber Mann den Hut.<gesture name="laugh" weight="0.7"/></p>

<p><emotion name="joy" weight="0.4"/><look at="visitor"/>Aus dem, was übrig blieb, goss ich <gesture name="heart"/>diese kleine hier an meiner Kette.
Ich trage sie, damit ich nie vergesse: <break time="300ms"/><prosody rate="86%">Keine Gabe ist so <gesture name="small" weight="0.8"/>klein, dass eine Glocke ohne sie auskäme.</prosody></p>
</story>
